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

// Reads block by block. The samples of `next`, fp32, stay valid until the next call.
class AudioSource {
 public:
  virtual ~AudioSource() = default;

  // False at the end of the sound. Throws Failure when it is truncated.
  virtual bool next(Audio& block, std::int64_t& pts_ns) = 0;

  // So far.
  [[nodiscard]] virtual Damage damage() const { return {}; }
};

// "-" is a WAV stream on stdin, a name ending in .wav a WAV file unless ffmpeg alone can read it;
// everything else goes through ffmpeg. Times are those of the input. Throws Failure.
std::unique_ptr<AudioSource> open_sound(const std::string& input, const InputOptions& options);

// Brings sound to a tracker as its frames need it.
class AudioFeed {
 public:
  using Listener = std::function<void(const Audio& block, std::int64_t pts_ns)>;

  AudioFeed(std::string input, std::unique_ptr<AudioSource> source)
      : input_(std::move(input)), source_(std::move(source)) {}

  // Hears all that the tracker hears.
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  // Pushes all that a frame at this time can make use of.
  void hear_until(std::int64_t pts_ns, Tracker& tracker);

  // Whether the sound lasts until then, as far as it was heard.
  [[nodiscard]] bool lasts_until(std::int64_t pts_ns) const { return end_ns_ > pts_ns; }

  [[nodiscard]] float peak() const { return peak_; }  // of what was heard, 1 being full scale
  [[nodiscard]] Damage damage() const { return source_->damage(); }

 private:
  std::string input_;
  std::unique_ptr<AudioSource> source_;
  Listener listener_;
  std::int64_t end_ns_ = INT64_MIN;  // of what was heard
  float peak_ = 0.0f;
  bool ended_ = false;
};

}  // namespace mien::app
