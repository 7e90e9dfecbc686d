// The avx2 tier of power_spectrum.
#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/power_spectrum/real_transform.h"

namespace mien::kernels::avx2 {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = avx2::kLanes;
  using Vec = __m256;

  static Vec splat(float x) { return _mm256_set1_ps(x); }
  static Vec load(const float* at) { return _mm256_loadu_ps(at); }
  static void store(float* at, Vec x) { _mm256_storeu_ps(at, x); }
  static Vec add(Vec a, Vec b) { return _mm256_add_ps(a, b); }
  static Vec sub(Vec a, Vec b) { return _mm256_sub_ps(a, b); }
  static Vec mul(Vec a, Vec b) { return _mm256_mul_ps(a, b); }
  static Vec add_product(Vec sum, Vec a, Vec b) { return _mm256_fmadd_ps(a, b, sum); }
  static Vec subtract_product(Vec sum, Vec a, Vec b) { return _mm256_fnmadd_ps(a, b, sum); }

  static void deinterleave(const float* x, Vec& even, Vec& odd) {
    const Vec a = load(x), b = load(x + kLanes);
    const Vec low = _mm256_permute2f128_ps(a, b, 0x20), high = _mm256_permute2f128_ps(a, b, 0x31);
    even = _mm256_shuffle_ps(low, high, 0x88);
    odd = _mm256_shuffle_ps(low, high, 0xDD);
  }

  static void transpose(Vec* v) {
    Vec pairs[kLanes];
    for (int i = 0; i < kLanes; i += 2) {
      pairs[i] = _mm256_unpacklo_ps(v[i], v[i + 1]);
      pairs[i + 1] = _mm256_unpackhi_ps(v[i], v[i + 1]);
    }
    Vec fours[kLanes];
    for (int i = 0; i < kLanes; i += 4) {
      fours[i] = _mm256_shuffle_ps(pairs[i], pairs[i + 2], 0x44);
      fours[i + 1] = _mm256_shuffle_ps(pairs[i], pairs[i + 2], 0xEE);
      fours[i + 2] = _mm256_shuffle_ps(pairs[i + 1], pairs[i + 3], 0x44);
      fours[i + 3] = _mm256_shuffle_ps(pairs[i + 1], pairs[i + 3], 0xEE);
    }
    for (int i = 0; i < 4; ++i) {
      v[i] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x20);
      v[i + 4] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x31);
    }
  }

  static Vec reversed(Vec x) {
    return _mm256_permutevar8x32_ps(x, _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0));
  }
};

}  // namespace

void power_spectrum(const PowerSpectrumArgs& a) { RealTransform<Simd>(a).power(); }

}  // namespace mien::kernels::avx2
