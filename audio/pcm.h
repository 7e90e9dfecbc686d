// Sound as callers have it -> one channel of floats that nothing can upset.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::audio {

inline constexpr std::int32_t kMaxChannels = 8;

enum class SampleFormat { kFloat32, kInt16 };

// Samples of all channels, interleaved in channel[0], or each channel in memory of its own.
// Borrowed for the duration of a call.
struct Pcm {
  SampleFormat format;
  bool planar;
  std::int32_t channels;  // 1..kMaxChannels
  std::size_t frames;
  const void* channel[kMaxChannels];  // aligned as its samples ask for
};

// The mean of the channels of frames [first, first + mono.size()), -1..1. What is no number counts
// as silence, what is beyond full scale as full scale, what fp32 holds with fewer digits as zero.
void to_mono(const Pcm& pcm, std::size_t first, std::span<float> mono);

}  // namespace mien::audio
