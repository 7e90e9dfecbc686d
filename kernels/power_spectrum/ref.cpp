// The reference kernel of power_spectrum.
#include <cstddef>

#include "kernels/families.h"

namespace mien::kernels::ref {

// The definition, evaluated directly: n is small.
void power_spectrum(const PowerSpectrumArgs& a) {
  for (std::int32_t k = 0; k <= a.n / 2; ++k) {
    double re = 0.0;
    double im = 0.0;
    for (std::int32_t j = 0; j < a.n; ++j) {
      const float* twiddle = a.twiddles + std::ptrdiff_t{2} * (j * k % a.n);
      re += static_cast<double>(a.x[j]) * static_cast<double>(twiddle[0]);
      im += static_cast<double>(a.x[j]) * static_cast<double>(twiddle[1]);
    }
    a.y[k] = static_cast<float>(re * re + im * im);
  }
}

}  // namespace mien::kernels::ref
