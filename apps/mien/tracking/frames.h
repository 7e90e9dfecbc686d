// The frames of `mien track`: those of a video with its audio, or 30 per second for the length of
// the audio.
#pragma once

#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/input.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/tracking/track.h"

namespace mien::app {

// The inputs to read.
struct InputTracks {
  std::optional<Input> input;  // empty: not read
  std::optional<Input> audio;  // a separate input with audio
  bool video = false;
  std::string sound;  // name of the input with audio; empty: no audio
};

// Throws Failure if a requested stream is missing.
[[nodiscard]] InputTracks choose(const TrackOptions& options);

// Very large numbers of seconds are clamped, so that they fit every count.
[[nodiscard]] VideoRange range_of(const TrackOptions& options);

// The decoded audio track.
struct AudioInfo {
  int track = 0;
  std::size_t tracks = 0;  // of the input
  float peak = 0;          // largest sample, 0..1
  std::int64_t decoding_errors = 0;
};

// Notes about the input after reading it. It holds no JSON: destroying JSON allocates, and aborts
// the program when that fails.
struct MediaReport {
  std::vector<std::string> notes;
  std::string lost;  // a message about frames that could not be decoded; empty: none
  std::optional<VideoInfo> video;
  std::int64_t video_decoding_errors = 0;
  std::optional<AudioInfo> audio;
};

class Frames {
 public:
  Frames(const TrackOptions& options, const InputTracks& tracks, Tracker& tracker);

  [[nodiscard]] VideoInfo info() const { return video_ ? video_->info() : VideoInfo(); }
  [[nodiscard]] const mien_image* image() const { return video_ ? &image_ : nullptr; }
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] std::string where() const {
    return options_.input + ": frame " + std::to_string(number_);
  }
  [[nodiscard]] MediaReport report() const;

  void set_listener(AudioFeed::Listener listener);

  // Tracks the next frame. Returns false at the end.
  bool next();

 private:
  bool next_image();
  bool next_sound();
  [[nodiscard]] std::size_t audio_tracks() const;
  [[nodiscard]] std::string silence_note() const;

  const TrackOptions& options_;
  const InputTracks& tracks_;
  std::int64_t start_ns_;
  Tracker& tracker_;
  std::unique_ptr<VideoSource> video_;
  std::optional<AudioFeed> sound_;
  mien_image image_;
  std::int64_t number_ = -1;
};

}  // namespace mien::app
