// Computes the input features of AudioNet.
#include "audio/front_end.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::audio {
namespace {

constexpr float kHighPass =
    static_cast<float>(1.0 - 2.0 * std::numbers::pi * 20.0 / kSampleRate);  // one pole at 20 Hz
constexpr float kMinState = 1e-20f;

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
  previous_sample_ = previous_filtered_ = 0.0f;
  window_size_ = 0;
  for (std::size_t w = 0; w < kWindows; ++w) {
    std::copy(silence_.begin(), silence_.end(),
              features_.begin() + static_cast<std::ptrdiff_t>(w * kCoefficients));
  }
}

float FrontEnd::high_pass(float sample) {
  const float filtered = sample - previous_sample_ + kHighPass * previous_filtered_;
  previous_sample_ = sample;
  // Flushes decaying values to 0 before they become denormal, which is slow.
  previous_filtered_ = std::abs(filtered) < kMinState ? 0.0f : filtered;
  return previous_filtered_;
}

bool FrontEnd::fetch(std::span<float, kFeatures> features) {
  for (float sample; window_size_ < kWindowSamples; ++window_size_) {
    if (!resampler_.fetch(sample)) {
      return false;
    }
    window_[window_size_] = high_pass(sample);
  }
  window_size_ = 0;
  std::copy(features_.begin() + kCoefficients, features_.end(), features_.begin());
  mfcc_.analyse(window_, std::span(features_).last<kCoefficients>());
  std::copy(features_.begin(), features_.end(), features.begin());
  return true;
}

}  // namespace mien::audio
