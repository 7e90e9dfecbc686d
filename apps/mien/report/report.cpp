// Collects the data of a report and writes its page.
#include "apps/mien/report/report.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "apps/animation/base64.h"
#include "apps/mien/avatar/avatar.h"
#include "apps/mien/pages/packed_text.h"
#include "apps/mien/pages/page_sources.h"
#include "apps/mien/pages/page_text.h"
#include "apps/mien/pages/web_video.h"
#include "apps/mien/report/exports.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

using nlohmann::ordered_json;

constexpr double kResolution = 1e-4;  // resolution of controls, shares and radians
constexpr double kMillimetre = 1e-3;
constexpr std::size_t kCoordinates = std::size_t{MIEN_LANDMARK_COUNT} * 2;

template <typename ValueOf>
std::vector<double> column_of(const std::vector<animation::Frame>& frames, ValueOf value_of) {
  std::vector<double> values(frames.size());
  std::transform(frames.begin(), frames.end(), values.begin(), value_of);
  return values;
}

void add_head(Columns& columns, const std::vector<animation::Frame>& frames) {
  const auto angle = [&](double animation::Angles::*of) {
    return column_of(frames, [of](const animation::Frame& frame) {
      return frame.head ? (*frame.head).*of : formats::kNoNumber;
    });
  };
  columns.add("pitch", kResolution, angle(&animation::Angles::pitch));
  columns.add("yaw", kResolution, angle(&animation::Angles::yaw));
  columns.add("roll", kResolution, angle(&animation::Angles::roll));
  const char* const names[] = {"x_m", "y_m", "z_m"};
  for (std::size_t i = 0; i < 3; ++i) {
    columns.add(names[i], kMillimetre, column_of(frames, [i](const animation::Frame& frame) {
                  return frame.position_m ? (*frame.position_m)[i] : formats::kNoNumber;
                }));
  }
}

void add_box(Columns& columns, const std::vector<animation::Frame>& frames, double unit) {
  const char* const names[] = {"box_x", "box_y", "box_width", "box_height"};
  for (std::size_t i = 0; i < 4; ++i) {
    columns.add(names[i], unit, column_of(frames, [i](const animation::Frame& frame) {
                  return frame.box ? (*frame.box)[i] : formats::kNoNumber;
                }));
  }
}

void add_controls(Columns& columns, const std::vector<animation::Frame>& frames) {
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    columns.add(
        mien_control_name(static_cast<std::int32_t>(i)), kResolution,
        column_of(frames, [i](const animation::Frame& frame) { return frame.controls[i]; }));
  }
}

ordered_json stages_json(const StageTimes& times) {
  ordered_json stages = ordered_json::object();
  for (const auto& [stage, time] : times.summary()) {
    stages[stage] = {
        {"median_ms", time.median_ms}, {"p95_ms", time.p95_ms}, {"total_ms", time.total_ms}};
  }
  return stages;
}

}  // namespace

std::string clip_beside(const std::string& page) { return page + ".mp4"; }

Report::Report(const ReportOptions& options) : options_(options), file_(options.page) {
  // Fine enough for display, and within 16 bits even if a face extends beyond the image.
  landmark_unit_ = std::max({options.width, options.height, 1}) / 8192.0;
  if (!options.video.empty() || !options.audio.empty()) {
    clip_file_.emplace(clip_beside(options.page), TemporaryFile::Ending::kAny);
  }
  if (!options.avatar.empty()) {
    glb_ = avatar_writer(options.avatar);
  }
}

void Report::frame(const animation::Frame& frame, const Result& result) {
  frames_.push_back(frame);
  const std::uint64_t took_ns =
      std::accumulate(result.stage_ns, result.stage_ns + MIEN_STAGE_COUNT, std::uint64_t{0});
  took_ms_.push_back(static_cast<double>(took_ns) * 1e-6);
  for (const auto& point : result.landmarks) {
    for (const float coordinate : point) {
      landmarks_.push_back(frame.box ? steps(coordinate, landmark_unit_) : kNoStep);
    }
  }
}

double Report::start_ms() const { return frames_.empty() ? 0.0 : frames_.front().time_ms(); }

double Report::end_ms() const {
  if (frames_.empty()) {
    return animation::mean_step_s(0, 0, 0) * 1e3;
  }
  const std::int64_t first_ns = frames_.front().time_ns, last_ns = frames_.back().time_ns;
  return frames_.back().time_ms() + animation::mean_step_s(first_ns, last_ns, frames_.size()) * 1e3;
}

Columns Report::columns() const {
  Columns columns;
  columns.add_times("t_ms", 0.1, column_of(frames_, [](const animation::Frame& frame) {
                      return frame.time_ms();
                    }));
  columns.add("status", 1.0, column_of(frames_, [](const animation::Frame& frame) {
                return static_cast<double>(frame.state);
              }));
  columns.add(
      "face_probability", kResolution,
      column_of(frames_, [](const animation::Frame& frame) { return frame.face_probability; }));
  columns.add("voice_activity", kResolution, column_of(frames_, [](const animation::Frame& frame) {
                return frame.voice_activity;
              }));
  columns.add("lod", 1.0, column_of(frames_, [](const animation::Frame& frame) {
                return static_cast<double>(frame.lod);
              }));
  columns.add("took_ms", 0.02, took_ms_);
  add_head(columns, frames_);
  add_box(columns, frames_, landmark_unit_);
  add_controls(columns, frames_);
  columns.add("sound_low", 1.0 / 127, waveform_.low());
  columns.add("sound_high", 1.0 / 127, waveform_.high());
  return columns;
}

std::string Report::packed_landmarks() const {
  const bool any = std::any_of(frames_.begin(), frames_.end(),
                               [](const animation::Frame& frame) { return frame.box.has_value(); });
  if (!any) {
    return {};
  }
  PackedText packed;
  std::vector<std::int16_t> column(frames_.size());
  for (std::size_t coordinate = 0; coordinate < kCoordinates; ++coordinate) {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      column[i] = landmarks_[i * kCoordinates + coordinate];
    }
    packed.write(differences_of(column));
  }
  return packed.finish();
}

Report::Clip Report::clip() {
  if (!clip_file_ || frames_.empty()) {
    return {};
  }
  std::string video = web_video({.video = options_.video,
                                 .audio = options_.audio,
                                 .audio_track = options_.audio_track,
                                 .rotation = options_.rotation,
                                 .start_s = start_ms() * 1e-3,
                                 .duration_s = (end_ms() - start_ms()) * 1e-3},
                                *clip_file_);
  if (static_cast<double>(video.size()) <= options_.max_clip_bytes) {
    return {.bytes = std::move(video), .beside = ""};
  }
  clip_file_->publish();
  return {.bytes = "", .beside = name_of(path_of(clip_beside(options_.page)).filename())};
}

ordered_json Report::facts(const StageTimes& times, const Clip& clip) const {
  ordered_json facts;
  facts["mien_report"] = 2;
  facts["program"] = std::string("mien ") + mien_version();
  facts["name"] = options_.name;
  facts["start_ms"] = start_ms();
  facts["end_ms"] = end_ms();
  facts["width"] = options_.width;
  facts["height"] = options_.height;
  facts["landmark_unit"] = landmark_unit_;
  facts["landmarks"] = MIEN_LANDMARK_COUNT;
  facts["sound_start_ms"] = static_cast<double>(waveform_.start_ns()) * 1e-6;
  facts["sound_bin_ms"] = static_cast<double>(Waveform::kBinNs) * 1e-6;
  facts["clip"] = clip.bytes.empty() ? clip.beside.empty() ? "none" : "beside" : "in page";
  facts["clip_file"] = clip.beside;
  facts["avatar"] = name_of(path_of(options_.avatar).filename());
  facts["stages"] = stages_json(times);
  return facts;
}

void Report::finish(const StageTimes& times) {
  const Clip clip = this->clip();
  ordered_json facts = this->facts(times, clip);
  const Columns columns = this->columns();
  facts["columns"] = columns.list();
  const std::string stem = name_of(path_of(options_.name).stem());
  const Exports exports =
      exports_of(frames_, options_.writing, stem.empty() ? "face" : stem, std::move(glb_));
  facts["exports"] = exports.list;
  file_.write(filled(kReportPage, {{"@VIEWER_HASH@", kViewerHash},
                                   {"@DATA@", script_text(facts)},
                                   {"@COLUMNS@", animation::base64(columns.bytes())},
                                   {"@AVATAR@", kAvatarScript},
                                   {"@BLOCKS@", block("landmarks", packed_landmarks()) +
                                                    block("clip", animation::base64(clip.bytes)) +
                                                    block("viewer", animation::base64(kViewer)) +
                                                    exports.blocks}}));
  file_.finish();
}

}  // namespace mien::app
