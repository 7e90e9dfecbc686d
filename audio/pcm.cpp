// Converts samples to mono floats.
#include "audio/pcm.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mien::audio {
namespace {

float sanitized(float sample) {
  const float magnitude = std::abs(sample);
  if (!(magnitude >= std::numeric_limits<float>::min()) ||
      magnitude == std::numeric_limits<float>::infinity()) {
    return 0.0f;
  }
  return std::clamp(sample, -1.0f, 1.0f);
}

float sanitized(std::int16_t sample) { return static_cast<float>(sample) / 32768.0f; }

template <class Sample>
void mean_of_channels(const Pcm& pcm, std::size_t first, std::span<float> mono) {
  const auto channels = static_cast<std::size_t>(pcm.channels);
  const std::size_t step = pcm.planar ? 1 : channels;
  const Sample* begin[kMaxChannels];
  for (std::size_t c = 0; c < channels; ++c) {
    begin[c] = pcm.planar ? static_cast<const Sample*>(pcm.channel[c])
                          : static_cast<const Sample*>(pcm.channel[0]) + c;
  }
  const float scale = 1.0f / static_cast<float>(channels);
  for (std::size_t i = 0; i < mono.size(); ++i) {
    float sum = 0.0f;
    for (std::size_t c = 0; c < channels; ++c) {
      sum += sanitized(begin[c][(first + i) * step]);
    }
    mono[i] = sum * scale;
  }
}

}  // namespace

void to_mono(const Pcm& pcm, std::size_t first, std::span<float> mono) {
  if (pcm.format == SampleFormat::kInt16) {
    mean_of_channels<std::int16_t>(pcm, first, mono);
  } else {
    mean_of_channels<float>(pcm, first, mono);
  }
}

}  // namespace mien::audio
