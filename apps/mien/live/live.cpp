#include "apps/mien/live/live.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>

#include "apps/mien/live/camera.h"
#include "apps/mien/live/easing.h"
#include "apps/mien/live/microphone.h"
#include "apps/mien/live/picture_points.h"
#include "apps/mien/live/screen.h"
#include "apps/mien/live/statistics.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/outputs/result_frame.h"
#include "apps/mien/senders/sender.h"
#include "apps/mien/sources/capture.h"
#include "apps/mien/sources/input.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/interrupt.h"
#include "apps/mien/system/shown.h"
#include "apps/mien/system/terminal.h"
#include "apps/mien/tracking/loaded_tracker.h"
#include "formats/animation/mirror.h"

namespace mien::app {
namespace {

constexpr const char* kNone = "none";
constexpr std::int64_t kFrameNs = 1'000'000'000 / 30;
constexpr std::int64_t kGlanceNs = 50'000'000;     // at the keyboard, while no picture comes
constexpr std::int64_t kPatienceNs = 500'000'000;  // then frames come without pictures
constexpr std::int64_t kSilentNs = 5'000'000'000;  // then the camera is opened anew
constexpr std::int64_t kRedrawNs = 100'000'000;
constexpr std::int32_t kQueuedSamples = 16000;

std::string file_played_by(const std::string& device) {
  return device.starts_with(kTest) ? device.substr(kTest.size()) : "";
}

// What is heard unless --mic says so: the sound of the file that plays the camera, or the first
// microphone beside a camera of this machine.
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

double time_of_day_s() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const double part =
      std::chrono::duration<double>(now - std::chrono::system_clock::from_time_t(seconds)).count();
  const std::tm* local = std::localtime(&seconds);  // of one thread
  return 3600.0 * local->tm_hour + 60.0 * local->tm_min + local->tm_sec + part;
}

class Live {
 public:
  explicit Live(const LiveOptions& options)
      : options_(options),
        camera_name_(options.camera.empty() ? default_device(CaptureKind::kCamera)
                                            : options.camera),
        microphone_name_(microphone_of(options, camera_name_)),
        loaded_({options.models, options.tier, options.lod, options.budget_ms, options.unfiltered,
                 1, microphone_name_ != kNone, false, options.voice_strength, options.fov_degrees,
                 microphone_name_ != kNone ? kQueuedSamples : 0}),
        camera_(camera_name_),
        mirror_(options.mirror),
        automatic_(options.lod == 0) {
    shown_.state = formats::FaceState::kSearching;
    require_distinct_files(
        {file_played_by(camera_name_), file_played_by(microphone_name_), options.neutral},
        {options.stats});
    if (microphone_name_ != kNone) {
      check(loaded_.tracker.set_audio_offset(std::llround(options.av_offset_ms * 1e6)),
            microphone_name_);
      microphone_ = std::make_unique<Microphone>(microphone_name_, loaded_.tracker);
    } else if (camera_name_ == kNone) {
      throw Failure(kExitUsage, "--camera none, --mic none: there is nothing to track");
    }
    if (!options.neutral.empty()) {
      load_neutral(options.neutral, loaded_.tracker);
    }
    for (const std::string& destination : options.destinations) {
      senders_.push_back(open_sender(destination));
    }
  }

  void run() {
    catch_interrupts();
    keyboard_ = std::make_unique<Keyboard>();
    page_ = options_.quiet ? nullptr : std::make_unique<Page>();
    begin_ns_ = last_picture_ns_ = steady_now_ns();
    camera_.start(begin_ns_);
    if (microphone_) {
      microphone_->start(begin_ns_);
    }
    while (!interrupted() && !quit_ && wanted() && !over() && step()) {
      take_keys();
      draw();
    }
    page_.reset();
    keyboard_.reset();
    finish();
  }

 private:
  // Ctrl-C in a terminal ends ffmpeg, too: that a camera gives nothing any more is no failure then.
  const Picture* newest(std::int64_t until_ns) {
    try {
      return camera_.newest(until_ns);
    } catch (const Failure&) {
      if (!interrupted()) {
        throw;
      }
      return nullptr;
    }
  }

  // False at the end of a file, and when it was interrupted while it waited.
  bool step() {
    const std::int64_t now_ns = steady_now_ns();
    const bool pictures = camera_name_ != kNone && now_ns - last_picture_ns_ < kPatienceNs;
    const std::int64_t due_ns =
        pictures ? last_picture_ns_ + kPatienceNs : last_output_ns_ + kFrameNs;
    const Picture* picture = newest(std::min(due_ns, now_ns + kGlanceNs));
    if (picture == nullptr && interrupted()) {
      return false;
    }
    if (picture != nullptr) {
      last_picture_ns_ = steady_now_ns();
      check(loaded_.tracker.push_video(picture->image, picture->time_ns), camera_name_);
      output(picture);
    } else if (camera_.ended() || (camera_name_ == kNone && microphone_->ended())) {
      return false;
    } else if (steady_now_ns() >= due_ns) {
      check(loaded_.tracker.advance(steady_now_ns()), camera_name_);
      output(nullptr);
    }
    if (had_image_ && now_ns - std::max(last_picture_ns_, last_restart_ns_) > kSilentNs) {
      last_restart_ns_ = now_ns;
      camera_.restart("no picture for 5 s; it is opened anew");
    }
    return true;
  }

  void output(const Picture* picture) {
    Result result;
    check(loaded_.tracker.get_result(result), camera_name_);
    if (picture != nullptr) {
      had_image_ = true;
      outgoing_.picture = openseeface_picture(result, picture->image, options_.fov_degrees);
    }
    const std::int64_t now_ns = steady_now_ns();
    outgoing_.frame = easing_.next(frame_of(number_++, result));
    outgoing_.since_start_s = static_cast<double>(now_ns - begin_ns_) * 1e-9;
    outgoing_.unix_time_s =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    outgoing_.time_of_day_s = time_of_day_s();
    if (mirror_) {
      Outgoing turned = outgoing_;
      turned.frame = formats::mirrored(outgoing_.frame);
      turned.picture = mirrored(outgoing_.picture);
      send(turned);
    } else {
      send(outgoing_);
    }
    last_output_ns_ = steady_now_ns();
    level_ = result.lod;
    calibrating_ = (result.flags & MIEN_RESULT_CAPTURING_NEUTRAL) != 0;
    statistics_.frame(result, last_output_ns_,
                      picture != nullptr ? last_output_ns_ - picture->there_ns : -1);
  }

  void send(const Outgoing& outgoing) {
    for (const std::unique_ptr<Sender>& sender : senders_) {
      dropped_packets_ += sender->send(outgoing) ? 0 : 1;
    }
    shown_ = outgoing.frame;
  }

  // Whether there is anybody to work for: a pipe's reader may have gone.
  [[nodiscard]] bool wanted() const {
    return senders_.empty() || std::any_of(senders_.begin(), senders_.end(),
                                           [](const auto& sender) { return sender->wanted(); });
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

  // A level without weights stays a key that does nothing.
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
    const std::string camera = camera_.trouble();
    const std::string microphone = microphone_ ? microphone_->trouble() : "";
    if (page_ && page_->there()) {
      page_->draw(screen_text(screen_state(camera, microphone), statistics_));
    } else if (page_) {
      say_once(camera, said_of_camera_);
      say_once(microphone, said_of_microphone_);
    }
  }

  [[nodiscard]] ScreenState screen_state(const std::string& camera,
                                         const std::string& microphone) const {
    ScreenState state;
    state.camera = shown(camera.empty() ? camera_name_ : camera + "; waiting for it");
    state.microphone =
        shown(microphone.empty() ? microphone_name_ : microphone + "; waiting for it");
    for (const std::unique_ptr<Sender>& sender : senders_) {
      const std::string more = sender->state();
      state.receivers.push_back(shown(sender->name() + (more.empty() ? "" : ", " + more)));
    }
    state.frame = shown_;
    state.level = level_;
    state.automatic = automatic_;
    state.mirrored = mirror_;
    state.calibrating = calibrating_;
    state.dropped_images = camera_.dropped();
    state.dropped_packets = dropped_packets_;
    return state;
  }

  // Where there is no screen, what went wrong is a line when it goes wrong.
  static void say_once(const std::string& trouble, std::string& said) {
    if (trouble != said && !trouble.empty()) {
      std::fprintf(stderr, "%s; waiting for it\n", shown(trouble).c_str());
    } else if (trouble != said) {
      std::fputs("it is back\n", stderr);
    }
    said = trouble;
  }

  void finish() {
    const double seconds = static_cast<double>(steady_now_ns() - begin_ns_) * 1e-9;
    const Histogram& latency = statistics_.latency();
    if (!options_.stats.empty()) {
      const nlohmann::ordered_json stats = {{"seconds", seconds},
                                            {"frames", statistics_.frames()},
                                            {"frames_with_face", statistics_.face_frames()},
                                            {"dropped_pictures", camera_.dropped()},
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
                   "frames %llu in %.1f s, with a face %llu, dropped pictures %llu, packets %llu\n"
                   "picture to sent: median %.1f ms, 99 %% within %.1f ms\n",
                   static_cast<unsigned long long>(statistics_.frames()), seconds,
                   static_cast<unsigned long long>(statistics_.face_frames()),
                   static_cast<unsigned long long>(camera_.dropped()),
                   static_cast<unsigned long long>(dropped_packets_), latency.quantile(0.5),
                   latency.quantile(0.99));
    }
  }

  const LiveOptions& options_;
  std::string camera_name_, microphone_name_;
  LoadedTracker loaded_;
  mutable Camera camera_;
  std::unique_ptr<Microphone> microphone_;  // none: nothing is heard
  std::vector<std::unique_ptr<Sender>> senders_;
  std::unique_ptr<Keyboard> keyboard_;
  std::unique_ptr<Page> page_;
  Easing easing_;
  LiveStatistics statistics_;
  Outgoing outgoing_;
  formats::Frame shown_;
  bool mirror_, automatic_, calibrating_ = false, quit_ = false, had_image_ = false;
  int level_ = 0;
  std::int64_t number_ = 0, begin_ns_ = 0;
  std::int64_t last_picture_ns_ = 0, last_output_ns_ = 0, last_draw_ns_ = 0, last_restart_ns_ = 0;
  std::uint64_t dropped_packets_ = 0;
  std::string said_of_camera_, said_of_microphone_;
};

}  // namespace

void live(const LiveOptions& options) { Live(options).run(); }

}  // namespace mien::app
