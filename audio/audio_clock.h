// Of what time a sample is: blocks of sound carry timestamps, and count their samples.
//
// The timestamps of a sound card tremble, and its clock is not the picture's: 50 parts in a million
// are 180 ms in an hour. So the count of the samples says how time passes from block to block, and
// the timestamps pull it along, by a first-order loop of one second. What is off by more than
// kSlewedNs is no trembling: samples are missing, or were heard twice.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::audio {

class AudioClock {
 public:
  enum class Flow {
    kSteady,  // the block goes on where the last one ended
    kHop,     // time has hopped there
    kBreak,   // the stream begins, or begins anew
  };

  static constexpr std::int64_t kSlewedNs = 20'000'000;
  static constexpr std::int64_t kHoppedNs = 500'000'000;
  static constexpr std::int64_t kExactNs = 100'000;  // timestamps are rounded: not pulled at

  // A block of `frames` samples begins at `pts_ns`, any value. `rate` is that of the block before
  // unless the stream began anew.
  Flow advance(std::int64_t pts_ns, std::size_t frames, std::int32_t rate);

  // The next block begins a stream.
  void restart() { started_ = false; }

  // Of what is `seconds` behind the stream's first sample.
  [[nodiscard]] std::int64_t time_ns(double seconds) const;

 private:
  [[nodiscard]] std::int64_t end_ns(std::int32_t rate) const;

  bool started_ = false;
  std::int64_t origin_ns_ = 0;  // of the first sample
  double pulled_ns_ = 0.0;      // the origin, beyond origin_ns_
  std::int64_t frames_ = 0;     // since then
};

}  // namespace mien::audio
