// An interface for the audio of an input, and its feed to a tracker.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mien/mien.hpp>
#include <string>

#include "apps/mien/sources/video_source.h"

namespace mien::app {

inline constexpr const char* kStandardInput = "-";  // the name that stands for standard input

// Reads block by block. The samples of `next`, fp32, stay valid until the next call.
class AudioSource {
 public:
  virtual ~AudioSource() = default;

  // Returns false at the end of the audio. Throws Failure if the audio is truncated.
  virtual bool next(Audio& block, std::int64_t& pts_ns) = 0;

  // Decoding errors until now.
  [[nodiscard]] virtual Damage damage() const { return {}; }
};

// Opens "-" as a WAV stream on standard input, and .wav files without ffmpeg if possible. Other
// inputs go through ffmpeg. Timestamps are those of the input. Throws Failure.
std::unique_ptr<AudioSource> open_audio_source(const std::string& input,
                                               const InputOptions& options);

// Pushes the audio of an input to a tracker as its frames need it.
class AudioFeed {
 public:
  using Listener = std::function<void(const Audio& block, std::int64_t pts_ns)>;

  AudioFeed(std::string input, std::unique_ptr<AudioSource> source)
      : input_(std::move(input)), source_(std::move(source)) {}

  // The listener receives each block that the tracker receives.
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  // Pushes the audio that a frame at `pts_ns` can use.
  void push_until(std::int64_t pts_ns, Tracker& tracker);

  // Whether the audio read until now extends beyond `pts_ns`.
  [[nodiscard]] bool lasts_until(std::int64_t pts_ns) const { return end_ns_ > pts_ns; }

  [[nodiscard]] float peak() const { return peak_; }  // largest absolute sample; 1 is full scale
  [[nodiscard]] Damage damage() const { return source_->damage(); }

 private:
  std::string input_;
  std::unique_ptr<AudioSource> source_;
  Listener listener_;
  std::int64_t end_ns_ = INT64_MIN;  // end of the audio read until now
  float peak_ = 0.0f;
  bool ended_ = false;
};

}  // namespace mien::app
