// `mien track`: video and sound go in, curves come out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

// What of picture and sound is taken: kAny what there is, the others just that.
enum class Mode { kAny, kBoth, kVideo, kAudio };

struct TrackOptions {
  std::string input;
  AnimationOptions animation;
  std::string landmarks;  // empty: none; so for the others
  std::string overlay;
  std::string report;
  double report_clip_mb = 64.0;  // a larger clip lies beside the report
  std::string audio;             // file with the sound; empty: the input
  Mode mode = Mode::kAny;
  double av_offset_ms = 0.0;  // that the sound is late by
  float voice_strength = 1.0f;
  float fov_degrees = 60.0f;
  std::string stats;
  std::string neutral;  // file to take into account
  std::string tier;
  bool unfused = false;  // networks run layer by layer
  std::string models;
  std::optional<int> lod;  // 0: automatic; none: the highest that there are weights for
  float budget_ms = 10.0f;
  bool unfiltered = false;
  int max_faces = 1;
  double start_s = 0.0;
  std::optional<double> duration_s;
  int audio_track = 1;          // the first is 1
  std::optional<int> rotation;  // degrees clockwise that make the video upright
  bool quiet = false;
  std::function<void()> after_frame;  // called after each; none: nothing
};

struct TrackSummary {
  std::uint64_t frames = 0;
  std::uint64_t face_frames = 0;
  std::string lost;                // of the input that could not be decoded; empty: nothing
  std::vector<std::string> notes;  // that were printed
};

// Throws Failure.
TrackSummary track(const TrackOptions& options);

}  // namespace mien::app
