#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {

void half_to_float(const HalfToFloatArgs& a) {
  std::int32_t i = 0;
  for (; i + kLanes <= a.n; i += kLanes) {
    _mm256_storeu_ps(a.y + i, load_half(a.x + i));
  }
  for (; i < a.n; ++i) {
    a.y[i] = _cvtsh_ss(a.x[i]);
  }
}

void float_to_half(const FloatToHalfArgs& a) {
  constexpr int kNearest = _MM_FROUND_TO_NEAREST_INT;
  std::int32_t i = 0;
  for (; i + kLanes <= a.n; i += kLanes) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(a.y + i),
                     _mm256_cvtps_ph(_mm256_loadu_ps(a.x + i), kNearest));
  }
  for (; i < a.n; ++i) {
    a.y[i] = static_cast<std::uint16_t>(_cvtss_sh(a.x[i], kNearest));
  }
}

}  // namespace mien::kernels::avx2
