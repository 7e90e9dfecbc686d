// Computes mel-frequency cepstral coefficients.
#include "audio/mfcc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::audio {
namespace {

using std::numbers::pi;

constexpr float kPreEmphasis = 0.97f;
constexpr double kMinHz = 60.0;
constexpr double kMaxHz = 7600.0;
constexpr double kLifter = 22.0;

double mel_of_hz(double hz) { return 2595.0 * std::log10(1.0 + hz / 700.0); }
double hz_of_mel(double mel) { return 700.0 * (std::pow(10.0, mel / 2595.0) - 1.0); }

// 0 outside low..high, 1 at `middle`, linear between.
double triangle(double x, double low, double middle, double high) {
  return std::max(0.0, std::min((x - low) / (middle - low), (high - x) / (high - middle)));
}

}  // namespace

bool Mfcc::init(std::uint32_t cpu_mask) {
  power_spectrum_ = kernels::find<kernels::PowerSpectrumArgs>(cpu_mask);
  matrix_vector_ = kernels::find<kernels::MatrixVectorArgs>(cpu_mask);
  make_window();
  make_mel_bands();
  make_cosines();
  return power_spectrum_ != nullptr && matrix_vector_ != nullptr;
}

void Mfcc::make_window() {
  for (std::size_t n = 0; n < kWindowSamples; ++n) {
    const double angle = 2.0 * pi * static_cast<double>(n);
    window_[n] = static_cast<float>(0.54 - 0.46 * std::cos(angle / (kWindowSamples - 1)));
    twiddles_[2 * n] = static_cast<float>(std::cos(angle / kWindowSamples));
    twiddles_[2 * n + 1] = static_cast<float>(-std::sin(angle / kWindowSamples));
  }
}

void Mfcc::make_mel_bands() {
  const double low = mel_of_hz(kMinHz);
  const double step = (mel_of_hz(kMaxHz) - low) / (kBands + 1);
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto edge = [&](std::size_t i) { return hz_of_mel(low + static_cast<double>(i) * step); };
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const double hz = static_cast<double>(bin) * kSampleRate / kWindowSamples;
      const double weight = triangle(hz, edge(band), edge(band + 1), edge(band + 2));
      mel_bands_[band * kBins + bin] = static_cast<float>(weight / kWindowSamples);
    }
  }
}

void Mfcc::make_cosines() {
  for (std::size_t i = 0; i < kCoefficients; ++i) {
    const double index = static_cast<double>(i);
    const double gain = std::sqrt((i == 0 ? 1.0 : 2.0) / kBands) *
                        (1.0 + kLifter / 2.0 * std::sin(pi * index / kLifter));
    for (std::size_t band = 0; band < kBands; ++band) {
      const double angle = pi * index * (static_cast<double>(band) + 0.5) / kBands;
      cosines_[i * kBands + band] = static_cast<float>(gain * std::cos(angle));
    }
  }
}

void Mfcc::analyse(std::span<const float, kWindowSamples> samples,
                   std::span<float, kCoefficients> coefficients) {
  std::array<float, kWindowSamples> windowed;
  for (std::size_t n = 0; n < kWindowSamples; ++n) {
    windowed[n] = (samples[n] - kPreEmphasis * previous_sample_) * window_[n];
    previous_sample_ = samples[n];
  }
  std::array<float, kBins> power;
  power_spectrum_({windowed.data(), twiddles_.data(), power.data(), kWindowSamples});
  matrix_vector_({mel_bands_.data(), power.data(), log_mel_.data(), kBands, kBins});
  for (float& band : log_mel_) {
    band = std::log(std::max(band, kEnergyFloor));
  }
  matrix_vector_({cosines_.data(), log_mel_.data(), coefficients.data(), kCoefficients, kBands});
}

}  // namespace mien::audio
