// Sound in blocks with timestamps in; what the voice does at any time lately out.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "audio/audio_clock.h"
#include "audio/audio_net.h"
#include "audio/front_end.h"
#include "audio/pcm.h"

namespace mien::audio {

class AudioPipeline {
 public:
  // What was heard longer ago is forgotten: sound may be ahead of the picture by this much.
  static constexpr std::size_t kRememberedSteps = 256;  // 4 s
  // For so long after the last of it, sound that is late counts as going on.
  static constexpr std::int64_t kPatienceNs = 150'000'000;

  // False when no tier of `cpu_mask` runs here. `net` is loaded.
  [[nodiscard]] bool init(const AudioNet& net, std::uint32_t cpu_mask);

  // Forgets everything.
  void reset();

  // `sound` is valid, its rate one of the resampler's. Whatever the blocks, the same sound gives
  // the same steps bit for bit.
  void push(const Pcm& sound, std::int32_t rate, std::int64_t pts_ns);

  // At that time, between the steps around it. With the last of them while the sound is late; else
  // nobody speaks where nothing was heard.
  [[nodiscard]] Speech at(std::int64_t time_ns) const;

 private:
  struct Moment {
    std::int64_t time_ns = 0;
    Speech speech;
  };

  void follow(AudioClock::Flow flow, std::int32_t rate);
  void process();
  void remember(const Moment& moment);
  [[nodiscard]] const Moment& moment(std::size_t back) const;

  FrontEnd front_end_;
  AudioNet net_;
  AudioClock clock_;
  std::int32_t rate_ = 0;
  std::int64_t stream_steps_ = 0;                      // since the front end started
  std::array<Moment, kRememberedSteps> moments_ = {};  // a ring
  std::size_t next_ = 0;
  std::size_t known_ = 0;
};

}  // namespace mien::audio
