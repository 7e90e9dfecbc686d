// Converts audio blocks with timestamps to predictions for any time of the last seconds.
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
  // Number of stored predictions: audio may be ahead of the images by this much.
  static constexpr std::size_t kStoredSteps = 256;  // 4 s
  // How long the latest prediction is held while audio is late.
  static constexpr std::int64_t kMaxHoldNs = 150'000'000;

  // False if no tier of `cpu_mask` can run on this CPU. `net` is loaded.
  [[nodiscard]] bool init(const AudioNet& net, std::uint32_t cpu_mask);

  // Returns to the state after init.
  void reset();

  // `pcm` must be valid, and `rate` (Hz) within the resampler's range. The same samples give
  // bit-identical predictions however they are divided into blocks.
  void push(const Pcm& pcm, std::int32_t rate, std::int64_t pts_ns);

  // The prediction for a time, interpolated between the steps before and after it. While audio is
  // late it is the latest one, for up to kMaxHoldNs; otherwise activity is 0 where there was no
  // audio.
  [[nodiscard]] Speech at(std::int64_t time_ns) const;

 private:
  struct Prediction {
    std::int64_t time_ns = 0;
    Speech speech;
  };

  void start_stream_if_broken(AudioClock::Flow flow, std::int32_t rate);
  void process();
  void store(const Prediction& prediction);
  // The stored prediction `back` steps before the latest.
  [[nodiscard]] const Prediction& stored(std::size_t back) const;

  FrontEnd front_end_;
  AudioNet net_;
  AudioClock clock_;
  std::int32_t rate_ = 0;
  std::int64_t stream_steps_ = 0;                          // since the front end was started
  std::array<Prediction, kStoredSteps> predictions_ = {};  // a ring buffer
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace mien::audio
