// Implements `mien track`, which tracks video and audio and writes animations.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

// The streams to use: kAny uses everything available, the others require theirs.
enum class Mode { kAny, kBoth, kVideo, kAudio };

struct TrackOptions {
  std::string input;
  AnimationOptions animation;
  std::string landmarks;  // path; empty: none, as for the next members
  std::string overlay;
  std::string report;
  double report_clip_mb = 64.0;  // a larger clip is stored beside the report
  std::string audio;             // file with the audio; empty: the input
  Mode mode = Mode::kAny;
  double av_offset_ms = 0.0;  // by which the audio is early
  float voice_strength = 1.0f;
  float fov_degrees = 60.0f;
  std::string stats;
  std::string neutral;  // neutral file; empty: none
  std::string tier;
  bool unfused = false;  // run networks layer by layer
  std::string models;
  std::optional<int> lod;  // 0: automatic; default: the highest with weights
  float budget_ms = 10.0f;
  bool unfiltered = false;
  int max_faces = 1;
  bool forward_only = false;  // leave frames before a detection empty
  double start_s = 0.0;
  std::optional<double> duration_s;
  int audio_track = 1;          // the first is 1
  std::optional<int> rotation;  // degrees clockwise that make the video upright
  bool quiet = false;
  std::function<void()> after_frame;  // called after each frame; may be empty
};

struct TrackSummary {
  std::uint64_t frames = 0;
  std::uint64_t face_frames = 0;
  std::string lost;                // a message about frames that could not be decoded; empty: none
  std::vector<std::string> notes;  // printed notes
};

// Throws Failure.
TrackSummary track(const TrackOptions& options);

}  // namespace mien::app
