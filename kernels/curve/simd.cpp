// The curve kernel of all vector tiers: a plain loop over the 8 channels of a block, which
// compilers vectorize.
#include "kernels/common/lanes.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

inline float limited(float x, float low, float high) {
  const float at_least = x < low ? low : x;
  return at_least > high ? high : at_least;
}

// exp(x) to 2 ulp on [-87, 88], clamped outside: 2^n e^r with r in [-ln2/2, ln2/2], a polynomial of
// degree 6 (Cephes expf by S. Moshier). Adding 1.5 * 2^23 rounds to an integer n, in the lowest
// bits.
inline float exp_of(float x) {
  x = limited(x, -87.0f, 88.0f);
  const float shifted = x * 1.44269504f + 12582912.0f;
  const float n = shifted - 12582912.0f;
  const float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
  float p = 1.9875691500e-4f;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = p * (r * r) + (r + 1.0f);
  const std::uint32_t power = ((__builtin_bit_cast(std::uint32_t, shifted) + 127u) & 0xFFu) << 23;
  return p * __builtin_bit_cast(float, power);
}

// 1 - erf(z) for z >= 0, to 1.5e-7 (Abramowitz & Stegun 7.1.26).
inline float erfc_of(float z) {
  const float t = 1.0f / (1.0f + 0.3275911f * z);
  float p = 1.061405429f;
  p = p * t - 1.453152027f;
  p = p * t + 1.421413741f;
  p = p * t - 0.284496736f;
  p = p * t + 0.254829592f;
  return p * t * exp_of(-z * z);
}

// Uses the power series near zero, where 1 - erfc cancels.
inline float erf_of(float x) {
  const float z = x < 0.0f ? -x : x, s = x * x;
  float p = -1.0f / 1320.0f;
  p = p * s + 1.0f / 216.0f;
  p = p * s - 1.0f / 42.0f;
  p = p * s + 0.1f;
  p = p * s - 1.0f / 3.0f;
  const float small = (p * s + 1.0f) * 1.12837917f * x;
  const float large = 1.0f - erfc_of(z);
  return z < 0.5f ? small : x < 0.0f ? -large : large;
}

inline float gelu_of(float x) {
  const float z = (x < 0.0f ? -x : x) * 0.707106781f;
  const float beyond = 0.5f * erfc_of(z);  // tail of the normal distribution beyond |x|
  return x * (x < 0.0f ? beyond : 1.0f - beyond);
}

inline float gelu_tanh_of(float x) {
  const float u = 1.59576912f * (x + 0.044715f * x * x * x);  // twice the tanh's argument
  return x / (1.0f + exp_of(-u));
}

template <Curve kKind>
inline float curve_of(float x) {
  if constexpr (kKind == Curve::kHardSwish) {
    return x * limited(x * (1.0f / 6.0f) + 0.5f, 0.0f, 1.0f);
  } else if constexpr (kKind == Curve::kSwish) {
    return x / (1.0f + exp_of(-x));
  } else if constexpr (kKind == Curve::kGelu) {
    return gelu_of(x);
  } else if constexpr (kKind == Curve::kGeluTanh) {
    return gelu_tanh_of(x);
  } else if constexpr (kKind == Curve::kErf) {
    return erf_of(x);
  } else if constexpr (kKind == Curve::kExp) {
    return exp_of(x);
  } else {
    return __builtin_sqrtf(x);
  }
}

// One loop over all elements, so that the compiler need not recognize blocks of 8 as vectors. The
// iterations are independent even if y is x, which the compiler cannot know.
template <Curve kKind>
void curve_map(const CurveArgs& a) {
  const std::ptrdiff_t elems = std::ptrdiff_t{blocks_for(a.channels)} * a.pixels * kBlockLanes;
  MIEN_INDEPENDENT for (std::ptrdiff_t i = 0; i < elems; ++i) { a.y[i] = curve_of<kKind>(a.x[i]); }
  clear_unused_lanes(a.y, a.pixels, a.channels);
}

}  // namespace

void curve(const CurveArgs& a) {
  switch (a.kind) {
    case Curve::kHardSwish:
      return curve_map<Curve::kHardSwish>(a);
    case Curve::kSwish:
      return curve_map<Curve::kSwish>(a);
    case Curve::kGelu:
      return curve_map<Curve::kGelu>(a);
    case Curve::kGeluTanh:
      return curve_map<Curve::kGeluTanh>(a);
    case Curve::kErf:
      return curve_map<Curve::kErf>(a);
    case Curve::kExp:
      return curve_map<Curve::kExp>(a);
    case Curve::kSqrt:
      return curve_map<Curve::kSqrt>(a);
  }
}

}  // namespace mien::kernels::MIEN_TIER
