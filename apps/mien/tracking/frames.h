// The frames that `mien track` tracks: those of a video with what is heard beside them, or 30 a
// second as long as there is sound.
#pragma once

#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/input.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/tracking/track.h"

namespace mien::app {

// What is looked at and listened to.
struct Senses {
  std::optional<Input> input;  // none: nothing of it is read
  std::optional<Input> audio;  // another input with the sound
  bool video = false;
  std::string sound;  // where from; empty: nowhere
};

// Throws Failure where what was asked for is not there.
[[nodiscard]] Senses choose(const TrackOptions& options);

// Seconds beyond all recordings are brought to what fits every count.
[[nodiscard]] VideoRange range_of(const TrackOptions& options);

// What is to be said of the input once it was read.
struct MediaReport {
  std::vector<std::string> notes;
  std::string lost;                // pictures or sound that could not be decoded; empty: none
  nlohmann::ordered_json as_json;  // for --stats
};

class Frames {
 public:
  Frames(const TrackOptions& options, const Senses& senses, Tracker& tracker);

  [[nodiscard]] VideoInfo info() const { return video_ ? video_->info() : VideoInfo(); }
  [[nodiscard]] const mien_image* image() const { return video_ ? &image_ : nullptr; }
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] std::string where() const {
    return options_.input + ": frame " + std::to_string(number_);
  }
  [[nodiscard]] MediaReport report() const;

  void set_listener(AudioFeed::Listener listener);

  // Tracks the next one. False at the end.
  bool next();

 private:
  bool next_image();
  bool next_sound();
  [[nodiscard]] std::size_t audio_tracks() const;
  [[nodiscard]] std::string silence_note() const;

  const TrackOptions& options_;
  const Senses& senses_;
  std::int64_t start_ns_;
  Tracker& tracker_;
  std::unique_ptr<VideoSource> video_;
  std::optional<AudioFeed> sound_;
  mien_image image_;
  std::int64_t number_ = -1;
};

}  // namespace mien::app
