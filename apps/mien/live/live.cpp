// Runs live tracking: capture, track, send, draw.
#include "apps/mien/live/live.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>

#include "apps/animation/mirror.h"
#include "apps/mien/live/advice.h"
#include "apps/mien/live/easing.h"
#include "apps/mien/live/inputs.h"
#include "apps/mien/live/openseeface_points.h"
#include "apps/mien/live/profile_file.h"
#include "apps/mien/live/screen.h"
#include "apps/mien/live/sender_set.h"
#include "apps/mien/live/statistics.h"
#include "apps/mien/live_page/page_link.h"
#include "apps/mien/live_page/token.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/outputs/result_frame.h"
#include "apps/mien/sources/capture.h"
#include "apps/mien/sources/input.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/interrupt.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/system/terminal.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

constexpr const char* kNone = LiveInputs::kNoInput;
constexpr std::int64_t kFrameNs = 1'000'000'000 / 30;
constexpr std::int64_t kKeyPollNs = 50'000'000;        // interval of keyboard polls without images
constexpr std::int64_t kImageTimeoutNs = 500'000'000;  // then frames are output without images
constexpr std::int64_t kRestartNs = 5'000'000'000;     // then the camera is reopened
constexpr std::int64_t kRedrawNs = 100'000'000;
constexpr std::int32_t kQueuedSamples = 16000;

std::string file_played_by(const std::string& device) {
  return device.starts_with(kTest) ? device.substr(kTest.size()) : "";
}

// The default of --mic: the audio of the file played as the camera, or the first microphone if the
// camera is a device of this machine.
std::string microphone_of(const LiveOptions& options, const std::string& camera) {
  if (options.microphone) {
    return *options.microphone;
  }
  if (!has_audionet(options.models) || is_url(camera)) {
    return kNone;
  }
  if (!camera.starts_with(kTest)) {
    return default_device(CaptureKind::kMicrophone);
  }
  return Input(file_played_by(camera)).has_audio() ? camera : kNone;
}

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

double time_of_day_s() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const double part =
      std::chrono::duration<double>(now - std::chrono::system_clock::from_time_t(seconds)).count();
  const std::tm* local = std::localtime(&seconds);  // safe, because only one thread calls it
  return 3600.0 * local->tm_hour + 60.0 * local->tm_min + local->tm_sec + part;
}

class Live {
 public:
  explicit Live(const LiveOptions& options)
      : options_(options),
        camera_name_(options.camera.empty() ? default_device(CaptureKind::kCamera)
                                            : options.camera),
        microphone_name_(microphone_of(options, camera_name_)),
        hears_(microphone_name_ != kNone || (options.page && has_audionet(options.models))),
        loaded_({options.models, options.tier, options.lod, options.budget_ms, options.unfiltered,
                 1, hears_, false, options.voice_strength, options.fov_degrees,
                 hears_ ? kQueuedSamples : 0}),
        inputs_(camera_name_, microphone_name_, options.page.has_value(), loaded_.tracker),
        senders_(options.destinations),
        mirror_(options.mirror),
        automatic_(options.lod == 0) {
    last_frame_.state = animation::FaceState::kSearching;
    require_distinct_files(
        {file_played_by(camera_name_), file_played_by(microphone_name_), options.neutral},
        {options.stats, options.profile, options.page_token});
    if (camera_name_ == kNone && microphone_name_ == kNone && !options.page) {
      throw Failure(kExitUsage, "--camera none, --mic none: no input to track");
    }
    if (hears_) {
      check(loaded_.tracker.set_audio_offset(std::llround(options.av_offset_ms * 1e6)),
            microphone_name_);
    }
    calibrate();
    if (options.page) {
      page_state_.profile_file = options.profile;
      web_page_.emplace(*options.page,
                        options.page_token.empty() ? new_token() : kept_token(options.page_token),
                        std::vector<std::string>{camera_name_, microphone_name_});
      std::fprintf(stderr, "page: %s\n", web_page_->url().c_str());
    }
  }

  void run() {
    catch_interrupts();
    keyboard_ = std::make_unique<Keyboard>();
    page_ = options_.quiet ? nullptr : std::make_unique<Page>();
    begin_ns_ = last_image_ns_ = steady_now_ns();
    start_inputs();
    while (!interrupted() && !quit_ && senders_.wanted() && !over() && step()) {
      take_keys();
      take_commands();
      draw();
    }
    page_.reset();
    keyboard_.reset();
    finish();
  }

 private:
  void calibrate() {
    if (!options_.profile.empty()) {
      profile_ = load_profile(options_.profile, options_.page.has_value(), loaded_.tracker);
    }
    if (!options_.neutral.empty()) {
      load_neutral(options_.neutral, loaded_.tracker);
    }
  }

  static Failure advised_failure(const Failure& failure) {
    return {failure.code(), advised(CaptureKind::kCamera, failure.what()), failure.details()};
  }

  void start_inputs() {
    try {
      inputs_.start(begin_ns_);
    } catch (const Failure& failure) {  // ffmpeg is missing, or the name is invalid
      throw advised_failure(failure);
    }
  }

  // Ctrl-C in a terminal also ends ffmpeg; the resulting camera failure is ignored.
  const CameraImage* newest(std::int64_t until_ns) {
    try {
      return inputs_.camera().newest(until_ns);
    } catch (const Failure& failure) {
      if (!interrupted()) {
        throw advised_failure(failure);
      }
      return nullptr;
    }
  }

  // Returns false at the end of a file, and if interrupted.
  bool step() {
    const std::int64_t now_ns = steady_now_ns();
    const bool has_images = inputs_.has_camera() && now_ns - last_image_ns_ < kImageTimeoutNs;
    const std::int64_t due_ns =
        has_images ? last_image_ns_ + kImageTimeoutNs : last_output_ns_ + kFrameNs;
    const CameraImage* image = newest(std::min(due_ns, now_ns + kKeyPollNs));
    if (image == nullptr && interrupted()) {
      return false;
    }
    if (image != nullptr) {
      last_image_ns_ = steady_now_ns();
      check(loaded_.tracker.push_video(image->image, image->time_ns), inputs_.camera_name());
      output(image);
    } else if (inputs_.camera().ended() || (!inputs_.has_camera() && inputs_.microphone_ended())) {
      return false;
    } else if (steady_now_ns() >= due_ns) {
      check(loaded_.tracker.advance(steady_now_ns()), inputs_.camera_name());
      output(nullptr);
    }
    if (had_image_ && now_ns - std::max(last_image_ns_, last_restart_ns_) > kRestartNs) {
      last_restart_ns_ = now_ns;
      inputs_.camera().restart("no image for 5 s; reopening");
    }
    return true;
  }

  void output(const CameraImage* image) {
    Result result;
    check(loaded_.tracker.get_result(result), inputs_.camera_name());
    if (image != nullptr) {
      had_image_ = true;
      outgoing_.image = openseeface_image(result, image->image, options_.fov_degrees);
    }
    const std::int64_t now_ns = steady_now_ns();
    const animation::Frame raw = easing_.next(frame_of(number_++, result));
    outgoing_.frame = profile_.applied(raw);
    outgoing_.since_start_s = static_cast<double>(now_ns - begin_ns_) * 1e-9;
    outgoing_.unix_time_s =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    outgoing_.time_of_day_s = time_of_day_s();
    if (mirror_) {
      Outgoing mirrored_outgoing = outgoing_;
      mirrored_outgoing.frame = animation::mirrored(outgoing_.frame);
      mirrored_outgoing.image = mirrored(outgoing_.image);
      send(mirrored_outgoing);
    } else {
      send(outgoing_);
    }
    last_output_ns_ = steady_now_ns();
    level_ = result.lod;
    calibrating_ = (result.flags & MIEN_RESULT_CAPTURING_NEUTRAL) != 0;
    statistics_.frame(result, last_output_ns_,
                      image != nullptr ? last_output_ns_ - image->arrival_ns : -1);
    if (web_page_) {
      web_page_->show(last_frame_, raw);
    }
    if (web_page_ && image != nullptr) {
      web_page_->show(image->image);
    }
  }

  void send(const Outgoing& outgoing) {
    dropped_packets_ += senders_.send(outgoing);
    last_frame_ = outgoing.frame;
  }

  [[nodiscard]] bool over() const {
    return options_.duration_s &&
           static_cast<double>(steady_now_ns() - begin_ns_) * 1e-9 >= *options_.duration_s;
  }

  void take_keys() {
    while (const auto key = keyboard_->pressed()) {
      if (*key == 'q') {
        quit_ = true;
      } else if (*key == 'm') {
        mirror_ = !mirror_;
      } else if (*key == 'c') {
        check(loaded_.tracker.capture_neutral(), "calibration");
      } else if (*key == 'a' || (*key >= '1' && *key <= '4')) {
        set_level(*key == 'a' ? 0 : *key - '0');
      }
    }
  }

  void take_commands() {
    while (const auto command = web_page_ ? web_page_->next_command() : std::nullopt) {
      page_state_.message.clear();
      try {
        obey(*command);
      } catch (const Failure& failure) {
        page_state_.message = failure.what();
      }
      last_draw_ns_ = 0;  // the page shows the effect at once
    }
  }

  void obey(const PageCommand& command) {
    std::visit(Overloaded{[&](const SetMirror& set) { mirror_ = set.mirror; },
                          [&](const SetLevel& set) { set_level(set.level); },
                          [&](const CaptureNeutral&) {
                            check(loaded_.tracker.capture_neutral(), "calibration");
                          },
                          [&](const SetSender& set) { senders_.pause(set.sender, set.paused); },
                          [&](const SetCamera& set) { set_camera(set.name); },
                          [&](const SetMicrophone& set) { set_microphone(set.name); },
                          [&](const Adjust& adjust) {
                            for (const ControlAdjustment& change : adjust.controls) {
                              profile_.controls[change.control] = change.adjustment;
                            }
                          },
                          [&](const SaveProfile&) { save(); }},
               command);
  }

  void set_camera(const std::string& name) {
    inputs_.set_camera(name);
    had_image_ = false;
    last_image_ns_ = steady_now_ns();
  }

  void set_microphone(const std::string& name) {
    if (name != kNone && !hears_) {
      throw Failure(kExitModel, "microphone: audionet.mien is missing");
    }
    inputs_.set_microphone(name);
  }

  void save() {
    take_neutral(loaded_.tracker, profile_);
    if (options_.profile.empty()) {
      web_page_->offer_profile(profile_);
    } else {
      save_profile(options_.profile, profile_);
    }
    ++page_state_.saved;
  }

  // Ignores a level without weights.
  void set_level(int level) {
    if (loaded_.tracker.set_lod(level) == MIEN_OK) {
      automatic_ = level == 0;
    }
  }

  void draw() {
    const std::int64_t now_ns = steady_now_ns();
    if (now_ns - last_draw_ns_ < kRedrawNs) {
      return;
    }
    last_draw_ns_ = now_ns;
    const ScreenState state = screen_state();
    if (web_page_) {
      web_page_->show(state, page_state_, statistics_, profile_);
    }
    if (page_ && page_->is_terminal()) {
      page_->draw(screen_text(state, statistics_));
    } else if (page_) {
      print_if_changed(state.camera.error, printed_camera_error_);
      print_if_changed(state.microphone.error, printed_microphone_error_);
    }
  }

  [[nodiscard]] ScreenState screen_state() {
    ScreenState state;
    state.camera = inputs_.camera_state();
    state.microphone = inputs_.microphone_state();
    state.receivers = senders_.states();
    state.page = web_page_ ? web_page_->url() : "";
    state.frame = last_frame_;
    state.level = level_;
    state.automatic = automatic_;
    state.mirrored = mirror_;
    state.calibrating = calibrating_;
    state.dropped_images = inputs_.dropped();
    state.dropped_packets = dropped_packets_;
    return state;
  }

  // Without a screen, prints errors when they change.
  static void print_if_changed(const std::string& error, std::string& printed) {
    if (error != printed && !error.empty()) {
      std::fprintf(stderr, "%s; retrying\n", printable(error).c_str());
    } else if (error != printed) {
      std::fputs("recovered\n", stderr);
    }
    printed = error;
  }

  void finish() {
    const double seconds = static_cast<double>(steady_now_ns() - begin_ns_) * 1e-9;
    const Histogram& latency = statistics_.latency();
    if (!options_.stats.empty()) {
      const nlohmann::ordered_json stats = {{"seconds", seconds},
                                            {"frames", statistics_.frames()},
                                            {"frames_with_face", statistics_.face_frames()},
                                            {"dropped_pictures", inputs_.dropped()},
                                            {"dropped_packets", dropped_packets_},
                                            {"latency_ms",
                                             {{"median", latency.quantile(0.5)},
                                              {"p99", latency.quantile(0.99)},
                                              {"max", latency.quantile(1.0)}}}};
      OutputFile file(options_.stats);
      file.write(stats.dump(1) + "\n");
      file.finish();
    }
    if (!options_.quiet) {
      std::fprintf(stderr,
                   "%llu frames in %.1f s, %llu with a face, dropped %llu images and %llu "
                   "packets\nlatency from image to packet: median %.1f ms, 99 %% within %.1f ms\n",
                   static_cast<unsigned long long>(statistics_.frames()), seconds,
                   static_cast<unsigned long long>(statistics_.face_frames()),
                   static_cast<unsigned long long>(inputs_.dropped()),
                   static_cast<unsigned long long>(dropped_packets_), latency.quantile(0.5),
                   latency.quantile(0.99));
    }
  }

  const LiveOptions& options_;
  std::string camera_name_, microphone_name_;  // at the start
  bool hears_;                                 // the tracker accepts audio
  LoadedTracker loaded_;
  LiveInputs inputs_;
  SenderSet senders_;
  Profile profile_;
  std::optional<PageLink> web_page_;
  std::unique_ptr<Keyboard> keyboard_;
  std::unique_ptr<Page> page_;
  PageState page_state_;
  Easing easing_;
  LiveStatistics statistics_;
  Outgoing outgoing_;
  animation::Frame last_frame_;
  bool mirror_, automatic_, calibrating_ = false, quit_ = false, had_image_ = false;
  int level_ = 0;
  std::int64_t number_ = 0, begin_ns_ = 0;
  std::int64_t last_image_ns_ = 0, last_output_ns_ = 0, last_draw_ns_ = 0, last_restart_ns_ = 0;
  std::uint64_t dropped_packets_ = 0;
  std::string printed_camera_error_, printed_microphone_error_;
};

}  // namespace

void live(const LiveOptions& options) { Live(options).run(); }

}  // namespace mien::app
