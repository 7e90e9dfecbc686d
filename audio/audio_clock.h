// Assigns a time to every audio sample, from the timestamps of blocks and the number of samples.
//
// Timestamps of audio have jitter, and the audio clock differs from that of the images: 50 ppm are
// 180 ms per hour. Therefore the number of samples determines the time between blocks, and a
// first-order loop with a time constant of one second corrects it towards the timestamps. A
// difference above kMaxSlewNs is not jitter: samples are missing or repeated.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::audio {

class AudioClock {
 public:
  enum class Flow {
    kSteady,  // the block continues the previous one
    kHop,     // the time jumps, the stream continues
    kBreak,   // a new stream starts
  };

  // Largest differences from the timestamps that are corrected gradually (kSteady), and at once
  // (kHop).
  static constexpr std::int64_t kMaxSlewNs = 20'000'000;
  static constexpr std::int64_t kMaxHopNs = 500'000'000;
  // Smaller differences are rounding of the timestamps and are ignored.
  static constexpr std::int64_t kToleranceNs = 100'000;

  // Adds a block of `frames` samples that starts at `pts_ns` (any value). `rate`, in Hz, may only
  // change after restart().
  Flow advance(std::int64_t pts_ns, std::size_t frames, std::int32_t rate);

  // The next block starts a new stream.
  void restart() { started_ = false; }

  // The time `seconds` after the stream's first sample.
  [[nodiscard]] std::int64_t time_ns(double seconds) const;

 private:
  // The time of the end of the latest block.
  [[nodiscard]] std::int64_t end_ns(std::int32_t rate) const;

  bool started_ = false;
  std::int64_t origin_ns_ = 0;  // time of the first sample
  double correction_ns_ = 0.0;  // added to origin_ns_
  std::int64_t frames_ = 0;     // since the first sample
};

}  // namespace mien::audio
