#include "audio/front_end.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::audio {
namespace {

constexpr float kHighPass =
    static_cast<float>(1.0 - 2.0 * std::numbers::pi * 20.0 / kSampleRate);  // one pole at 20 Hz
constexpr float kNothing = 1e-20f;

}  // namespace

bool FrontEnd::init(std::uint32_t cpu_mask) {
  if (!resampler_.init(cpu_mask) || !mfcc_.init(cpu_mask)) {
    return false;
  }
  mfcc_.analyse(window_, silence_);
  return true;
}

void FrontEnd::start(std::int32_t input_rate) {
  resampler_.start(input_rate);
  mfcc_.reset();
  sample_before_ = filtered_before_ = 0.0f;
  known_ = 0;
  for (std::size_t w = 0; w < kWindows; ++w) {
    std::copy(silence_.begin(), silence_.end(),
              features_.begin() + static_cast<std::ptrdiff_t>(w * kCoefficients));
  }
}

float FrontEnd::without_offset(float sample) {
  const float filtered = sample - sample_before_ + kHighPass * filtered_before_;
  sample_before_ = sample;
  // What fades away must not become denormal, which is slow.
  filtered_before_ = std::abs(filtered) < kNothing ? 0.0f : filtered;
  return filtered_before_;
}

bool FrontEnd::fetch(std::span<float, kFeatures> features) {
  for (float sample; known_ < kWindowSamples; ++known_) {
    if (!resampler_.fetch(sample)) {
      return false;
    }
    window_[known_] = without_offset(sample);
  }
  known_ = 0;
  std::copy(features_.begin() + kCoefficients, features_.end(), features_.begin());
  mfcc_.analyse(window_, std::span(features_).last<kCoefficients>());
  std::copy(features_.begin(), features_.end(), features.begin());
  return true;
}

}  // namespace mien::audio
