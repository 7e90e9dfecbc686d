// Mel-frequency cepstral coefficients (Davis, Mermelstein 1980) of consecutive windows.
//
// For every 256 samples at 16 kHz (16 ms), as in the HTK book (Young et al. 2006, ch. 5):
//   pre-emphasis x_n - 0.97 x_(n-1), across window borders
//   Hamming window 0.54 - 0.46 cos(2 pi n / 255)
//   power spectrum |X_k|^2 / 256, k = 0 .. 128
//   26 triangles, evenly spaced on mel(f) = 2595 log10(1 + f/700) from 60 Hz to 7600 Hz, each
//     reaching from one neighbour's centre to the other's
//   natural logarithm, of at least 1e-8 (80 dB below full scale)
//   orthonormal DCT-II, all 26 coefficients
//   lifter 1 + 11 sin(pi i / 22) of coefficient i
// tests/golden/make_mfcc.py is an independent implementation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/matrix_vector/matrix_vector.h"
#include "kernels/power_spectrum/power_spectrum.h"
#include "kernels/registry.h"

namespace mien::audio {

inline constexpr std::int32_t kSampleRate = 16000;
inline constexpr std::size_t kWindowSamples = 256;
inline constexpr std::size_t kCoefficients = 26;
inline constexpr std::size_t kBands = 26;
inline constexpr float kEnergyFloor = 1e-8f;  // of a band, before its logarithm

class Mfcc {
 public:
  // False if no tier of `cpu_mask` can run on this CPU.
  [[nodiscard]] bool init(std::uint32_t cpu_mask);

  void reset() { previous_sample_ = 0.0f; }

  // Analyses the next window; samples in -1..1.
  void analyse(std::span<const float, kWindowSamples> samples,
               std::span<float, kCoefficients> coefficients);

  // The logarithms of the bands of the latest window.
  [[nodiscard]] std::span<const float, kBands> log_mel() const { return log_mel_; }

 private:
  static constexpr std::size_t kBins = kWindowSamples / 2 + 1;

  void make_window();
  void make_mel_bands();
  void make_cosines();

  kernels::Kernel<kernels::PowerSpectrumArgs> power_spectrum_ = nullptr;
  kernels::Kernel<kernels::MatrixVectorArgs> matrix_vector_ = nullptr;
  float previous_sample_ = 0.0f;  // last sample of the previous window
  std::array<float, kBands> log_mel_ = {};
  std::array<float, kWindowSamples> window_ = {};
  std::array<float, 2 * kWindowSamples> twiddles_ = {};
  std::array<float, kBands* kBins> mel_bands_ = {};        // [bands, bins], 1/256 included
  std::array<float, kCoefficients* kBands> cosines_ = {};  // [coefficients, bands], liftered
};

}  // namespace mien::audio
