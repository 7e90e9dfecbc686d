// Resamples audio to 16 kHz.
#include "audio/resampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::audio {
namespace {

constexpr double kKaiserBeta = 8.6;  // side lobes 86 dB down
// Centre of the transition band, relative to the Nyquist frequency of the lower rate.
constexpr double kCutoff = 0.91;

// Modified Bessel function of the first kind and order 0, by its power series.
double bessel_i0(double x) {
  double term = 1.0;
  double sum = 1.0;
  for (int k = 1; term > 1e-18 * sum; ++k) {
    term *= (x / (2.0 * k)) * (x / (2.0 * k));
    sum += term;
  }
  return sum;
}

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-9 ? 1.0 : std::sin(angle) / angle;
}

// x in -1..1. Not normalized to 1 at 0, because filters are divided by their sum.
double kaiser(double x) { return bessel_i0(kKaiserBeta * std::sqrt(std::max(0.0, 1.0 - x * x))); }

}  // namespace

bool Resampler::init(std::uint32_t cpu_mask) {
  matrix_vector_ = kernels::find<kernels::MatrixVectorArgs>(cpu_mask);
  return matrix_vector_ != nullptr;
}

void Resampler::start(std::int32_t input_rate) {
  if (input_rate != rate_) {
    rate_ = input_rate;
    make_filter();
  }
  // The past half of the filter starts with silence.
  history_size_ = static_cast<std::size_t>(half_ - 1);
  std::fill_n(history_.begin(), history_size_, 0.0f);
  whole_ = 0;
  part_ = 0;
}

void Resampler::make_filter() {
  const std::int32_t steps = std::max(1, (rate_ + kOutputRate - 1) / kOutputRate);
  half_ = kZeroCrossings * steps;
  phases_ = kPhases / steps;
  const double cutoff = kCutoff * std::min(1.0, static_cast<double>(kOutputRate) / rate_);
  for (std::int32_t phase = 0; phase <= phases_; ++phase) {
    float* taps = filter_.data() + std::ptrdiff_t{2} * half_ * phase;
    double exact[kMaxTaps];
    double sum = 0.0;
    for (std::int32_t k = 0; k < 2 * half_; ++k) {
      const double offset = k - (half_ - 1) - static_cast<double>(phase) / phases_;
      sum += exact[k] = sinc(cutoff * offset) * kaiser(offset / half_);
    }
    for (std::int32_t k = 0; k < 2 * half_; ++k) {
      taps[k] = static_cast<float>(exact[k] / sum);
    }
  }
}

std::size_t Resampler::take(std::span<const float> input) {
  if (history_size_ == history_.size()) {
    drop_used();
  }
  const std::size_t count = std::min(input.size(), history_.size() - history_size_);
  std::copy_n(input.begin(), count, history_.begin() + static_cast<std::ptrdiff_t>(history_size_));
  history_size_ += count;
  return count;
}

bool Resampler::fetch(float& output) {
  if (static_cast<std::size_t>(whole_) + static_cast<std::size_t>(2 * half_) > history_size_) {
    return false;
  }
  const std::int64_t position = std::int64_t{part_} * phases_;
  const std::int64_t phase = position / kOutputRate;
  const float weight = static_cast<float>(position % kOutputRate) / kOutputRate;
  float at_phase[2];
  matrix_vector_({filter_.data() + std::ptrdiff_t{2} * half_ * phase, history_.data() + whole_,
                  at_phase, 2, 2 * half_});
  output = at_phase[0] + weight * (at_phase[1] - at_phase[0]);
  advance();
  return true;
}

void Resampler::advance() {
  part_ += rate_;
  whole_ += part_ / kOutputRate;
  part_ %= kOutputRate;
}

// Moves the inputs that later outputs need to the front.
void Resampler::drop_used() {
  const auto used = std::min(static_cast<std::size_t>(whole_), history_size_);
  std::copy(history_.begin() + static_cast<std::ptrdiff_t>(used),
            history_.begin() + static_cast<std::ptrdiff_t>(history_size_), history_.begin());
  history_size_ -= used;
  whole_ -= static_cast<std::int64_t>(used);
}

}  // namespace mien::audio
