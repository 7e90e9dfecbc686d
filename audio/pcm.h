// Converts the caller's samples to one channel of finite floats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mien::audio {

inline constexpr std::int32_t kMaxChannels = 8;

enum class SampleFormat { kFloat32, kInt16 };

// Samples of all channels: interleaved in channel[0], or planar in one buffer per channel. Valid
// during a call only.
struct Pcm {
  SampleFormat format;
  bool planar;
  std::int32_t channels;              // 1..kMaxChannels
  std::size_t frames;                 // samples per channel
  const void* channel[kMaxChannels];  // aligned to the type of the samples
};

// Writes the mean of the channels of frames [first, first + mono.size()), -1..1. NaN, infinity and
// denormal numbers count as 0; other values are clamped to full scale.
void to_mono(const Pcm& pcm, std::size_t first, std::span<float> mono);

}  // namespace mien::audio
