// The avx512fp16 tier of inverted_residual: strips and bands in half precision, 32 channels per
// panel.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/depthwise_rows.h"
#include "kernels/inverted_residual/half_strips.h"

namespace mien::kernels::avx512fp16 {
namespace {

using Vec = __m512h;

static_assert(kSumsElems <= kInvertedResidualFp32WeightElems);

__m512i joined(__m256i low, __m256i high) {
  return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

// Loads 8 fp16 values of each of up to 4 blocks, `step` apart.
Vec load_blocks(const Half* at, std::ptrdiff_t step, std::int32_t blocks) {
  const auto block = [&](std::int32_t i) {
    return i < blocks ? _mm_loadu_si128(reinterpret_cast<const __m128i*>(at + i * step))
                      : _mm_setzero_si128();
  };
  return _mm512_castsi512_ph(
      joined(_mm256_set_m128i(block(1), block(0)), _mm256_set_m128i(block(3), block(2))));
}

// Loads and converts the same number of floats.
Vec to_half(const float* at, std::ptrdiff_t step, std::int32_t blocks) {
  const auto pair = [&](std::int32_t i) {
    return i < blocks ? _mm512_cvtxps_ph(avx512::load_blocks(at + i * step, step, i + 1 < blocks))
                      : _mm256_setzero_ph();
  };
  return _mm512_castsi512_ph(joined(_mm256_castph_si256(pair(0)), _mm256_castph_si256(pair(2))));
}

Vec weights_at(const InvertedResidualArgs& a, const DepthwisePart<Half>& s, std::int32_t tap) {
  const std::ptrdiff_t taps = std::ptrdiff_t{a.kernel_h} * a.kernel_w;
  return load_blocks(a.depthwise.weights + (s.block * taps + tap) * 8, taps * 8, s.blocks);
}

struct Window {
  using Value = Half;
  using Vec = avx512fp16::Vec;
  static constexpr std::ptrdiff_t kStrip = kHalves, kBand = kHalves;

  const InvertedResidualArgs& a;
  const DepthwisePart<Half>& s;
  std::ptrdiff_t x_row_elems;
  Vec bias, low, high;

  static Vec load(const Half* x) { return _mm512_loadu_ph(x); }
  static Vec fma(Vec sum, Vec value, Vec weight) { return _mm512_fmadd_ph(value, weight, sum); }
  [[nodiscard]] Vec weight(int tap) const { return weights_at(a, s, tap); }
  void store(Vec sum, Half* y) const {
    _mm512_storeu_ph(y, _mm512_min_ph(high, _mm512_max_ph(low, sum)));
  }
};

struct Tier {
  static constexpr std::int32_t kPanel = kHalves;

  static void half_input(const float* x, std::ptrdiff_t plane, std::int32_t blocks, Half* y) {
    _mm512_storeu_ph(y, to_half(x, plane, blocks));
  }

  static void depthwise(const InvertedResidualArgs& a, const DepthwisePart<Half>& s, Half* y) {
    const Window window{a,
                        s,
                        s.x_row_elems,
                        load_blocks(a.depthwise.bias + s.block * 8, 8, s.blocks),
                        _mm512_set1_ph(static_cast<_Float16>(s.clamp.low)),
                        _mm512_set1_ph(static_cast<_Float16>(s.clamp.high))};
    DepthwiseRows<Window>::run(window, s.rows, s.x, y);
  }

  static void multiply_to_strip(const HalfProduct& product, const StripRows& to) {
    avx512fp16::multiply_to_strip(product, to);
  }
  static void multiply_to_map(const HalfProduct& product, const MapRows& to, float* fp32_weights) {
    avx512fp16::multiply_to_map(product, to, fp32_weights);
  }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  if (HalfStrips<Tier>::can_run(a)) {
    InvertedResidual<HalfStrips<Tier>>(a).run();
  } else {
    avx512::inverted_residual(a);
  }
}

}  // namespace mien::kernels::avx512fp16
