// The avx512vnni tier of fma_peak.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/fma_peak/integer_peak.h"

namespace mien::kernels::avx512vnni {
namespace {

struct IntegerVector {
  using Sum = __m512i;
  static constexpr int kSums = 16;
  static constexpr int kProducts = 2 * avx512::kPanel;

  static Sum all(int value) { return _mm512_set1_epi32(value); }
  static Sum add(Sum a, Sum b) { return _mm512_add_epi32(a, b); }
  static Sum bit_and(Sum a, Sum b) { return _mm512_and_si512(a, b); }
  static Sum bit_or(Sum a, Sum b) { return _mm512_or_si512(a, b); }
  static Sum multiply_add(Sum sum, Sum value, Sum weight) {
    return _mm512_dpwssd_epi32(sum, value, weight);
  }
  static void store(Sum sum, float* y) {
    _mm256_storeu_ps(y, _mm256_cvtepi32_ps(_mm512_castsi512_si256(sum)));
  }
};

}  // namespace

void fma_peak(const FmaPeakArgs& a) { integer_peak<IntegerVector>(a); }

}  // namespace mien::kernels::avx512vnni
