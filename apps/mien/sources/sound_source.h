// Sound of a file, whatever it comes from.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mien/mien.hpp>
#include <string>

#include "apps/mien/sources/video_source.h"

namespace mien::app {

inline constexpr const char* kStandardInput = "-";  // the name of an input

// Reads block by block. The samples of `next` stay valid until the next call.
class SoundSource {
 public:
  virtual ~SoundSource() = default;

  // False at the end of the sound. Throws Failure when it is damaged or truncated.
  virtual bool next(Audio& block, std::int64_t& pts_ns) = 0;
};

// A WAV file, which needs no ffmpeg.
bool is_wav(const std::string& input);

// "-" is a WAV stream on stdin, a name ending in .wav a WAV file; everything else goes through
// ffmpeg. Times are those of the input. Throws Failure.
std::unique_ptr<SoundSource> open_sound(const std::string& input, const VideoRange& range);

// Brings sound to a tracker as its frames need it.
class SoundFeed {
 public:
  using Listener = std::function<void(const Audio& block, std::int64_t pts_ns)>;

  SoundFeed(const std::string& input, const VideoRange& range)
      : input_(input), source_(open_sound(input, range)) {}

  // Hears all that the tracker hears.
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  // Pushes all that a frame at this time can make use of.
  void hear_until(std::int64_t pts_ns, Tracker& tracker);

  // Whether the sound lasts until then, as far as it was heard.
  [[nodiscard]] bool lasts_until(std::int64_t pts_ns) const { return end_ns_ > pts_ns; }

 private:
  std::string input_;
  std::unique_ptr<SoundSource> source_;
  Listener listener_;
  std::int64_t end_ns_ = INT64_MIN;  // of what was heard
  bool ended_ = false;
};

}  // namespace mien::app
