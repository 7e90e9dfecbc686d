// The avx512vnni tier of inverted_residual. Strips are fp32; the inputs of expand and project are
// 16-bit integers: the map scaled by its largest magnitude, the band by the bound of its clamp.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/avx512_depthwise.h"
#include "kernels/inverted_residual/depthwise_rows.h"
#include "kernels/inverted_residual/float_strips.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels::avx512vnni {
namespace {

using avx512::Vec;

// Factor that quantizes the band: its range 0..high becomes 0..kQuantizedBandMax.
float band_factor(float high) { return static_cast<float>(kQuantizedBandMax) / high; }

Vec weights_at(const InvertedResidualArgs& a, const DepthwisePart<float>& s, std::int32_t tap) {
  return _mm512_mul_ps(avx512::weights_at(a, s, tap), _mm512_set1_ps(band_factor(s.clamp.high)));
}

// Computes quantized values of the band.
struct Window {
  using Value = float;
  using Vec = avx512vnni::Vec;
  // 8 integers of the band occupy the memory of 4 floats.
  static constexpr std::ptrdiff_t kStrip = kFloatPanel, kBand = kStripBlock / 2;

  const InvertedResidualArgs& a;
  const DepthwisePart<float>& s;
  std::ptrdiff_t x_row_elems;
  std::ptrdiff_t y_plane_elems;
  bool both;  // the upper 8 channels exist
  Vec bias, high;

  static Vec load(const float* x) { return _mm512_loadu_ps(x); }
  static Vec fma(Vec sum, Vec value, Vec weight) { return _mm512_fmadd_ps(value, weight, sum); }
  [[nodiscard]] Vec weight(int tap) const { return weights_at(a, s, tap); }
  void store(Vec sum, float* y) const {
    const Vec clamped = _mm512_min_ps(high, _mm512_max_ps(_mm512_setzero_ps(), sum));
    const __m256i fixed = _mm512_cvtepi32_epi16(_mm512_cvtps_epi32(clamped));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(y), _mm256_castsi256_si128(fixed));
    if (both) {
      _mm_storeu_si128(reinterpret_cast<__m128i*>(y + y_plane_elems),
                       _mm256_extracti128_si256(fixed, 1));
    }
  }
};

void depthwise_rows(const InvertedResidualArgs& a, const DepthwisePart<float>& s) {
  const bool both = s.blocks > 1;
  const std::ptrdiff_t plane = band_plane(a, s) / 2;
  const Window window{a,
                      s,
                      s.x_row_elems,
                      plane,
                      both,
                      _mm512_mul_ps(avx512::load_half(a.depthwise.bias + s.block * kStripBlock,
                                                      both ? 0xFFFF : 0xFF),
                                    _mm512_set1_ps(band_factor(s.clamp.high))),
                      _mm512_set1_ps(kQuantizedBandMax)};
  DepthwiseRows<Window>::run(
      window, s.rows, s.x,
      a.band + s.block * plane + std::ptrdiff_t{s.row} * a.out_w * Window::kBand);
}

// Largest magnitude, at least 2^-64. `elems` must be a multiple of 8.
float largest_of(const float* x, std::ptrdiff_t elems) {
  constexpr int kAtOnce = 4;  // independent, because each maximum waits for the previous one
  Vec largest[kAtOnce];
  for (Vec& one : largest) {
    one = _mm512_set1_ps(0x1p-64f);  // far smaller values become 0
  }
  const auto take = [&](Vec& one, Vec values) { one = _mm512_max_ps(one, _mm512_abs_ps(values)); };
  for (; elems >= 16 * kAtOnce; elems -= 16 * kAtOnce, x += 16 * kAtOnce) {
    for (int k = 0; k < kAtOnce; ++k) {
      take(largest[k], _mm512_loadu_ps(x + 16 * k));
    }
  }
  for (; elems > 0; elems -= 16, x += 16) {
    take(largest[0],
         _mm512_maskz_loadu_ps(avx512::first_lanes(static_cast<std::int32_t>(elems)), x));
  }
  for (int k = 1; k < kAtOnce; ++k) {
    take(largest[0], largest[k]);
  }
  return _mm512_reduce_max_ps(largest[0]);
}

void quantize(const float* x, std::ptrdiff_t elems, Vec inverse_scale, std::int16_t* y) {
  for (; elems > 0; elems -= 16, x += 16, y += 16) {
    const __mmask16 lanes = elems >= 16 ? 0xFFFF : 0xFF;
    const Vec values = _mm512_mul_ps(_mm512_maskz_loadu_ps(lanes, x), inverse_scale);
    _mm256_mask_storeu_epi16(y, lanes, _mm512_cvtsepi32_epi16(_mm512_cvtps_epi32(values)));
  }
}

class QuantizedStrips {
 public:
  using Value = float;
  static constexpr std::int32_t kPanel = kFloatPanel;

  explicit QuantizedStrips(const InvertedResidualArgs& args)
      : a_(args), map_(reinterpret_cast<std::int16_t*>(args.half_input)) {
    if (a_.expand.weights != nullptr) {
      largest_ = largest_of(a_.x, (a_.in_c + 7) / 8 * map_plane());
    }
  }

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.weights == nullptr) {
      return;
    }
    first_row_ = first;
    plane_elems_ = std::ptrdiff_t{rows} * a_.in_w * kStripBlock;
    const Vec inverse_scale = _mm512_set1_ps(static_cast<float>(kQuantizedMapMax) / largest_);
    const float* x = a_.x + std::ptrdiff_t{first} * a_.in_w * kStripBlock;
    for (std::int32_t block = 0; block < (a_.in_c + 7) / 8; ++block) {
      quantize(x + block * map_plane(), plane_elems_, inverse_scale, map_ + block * plane_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kStripBlock;
    QuantizedProduct product{};
    product.to = expansion(a_, part, row, rows, y);
    product.values = map_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kStripBlock;
    product.plane_elems = plane_elems_;
    product.x_scale = largest_ / static_cast<float>(kQuantizedMapMax);
    product.pairs = a_.expand.pairs + channel * product.to.in_blocks * kStripBlock;
    product.scales = a_.expand.scales + channel;
    multiply_quantized_to_strip(product);
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, float* y) const {
    copy_rows(a_, part, row, rows, y,
              [](const float* from, float* to) { _mm256_storeu_ps(to, _mm256_loadu_ps(from)); });
  }

  void depthwise(const DepthwisePart<float>& s) const { depthwise_rows(a_, s); }

  void project(std::int32_t first, std::int32_t rows) const {
    QuantizedProduct product{};
    product.to = projection(a_, first, rows);
    product.values = reinterpret_cast<const std::int16_t*>(a_.band);
    product.plane_elems = product.to.x_plane_elems;
    product.x_scale =
        clamp_of(a_.depthwise.activation).high / static_cast<float>(kQuantizedBandMax);
    product.pairs = a_.project.pairs;
    product.scales = a_.project.scales;
    multiply_quantized_to_map(product);
  }

 private:
  [[nodiscard]] std::ptrdiff_t map_plane() const {
    return std::ptrdiff_t{a_.in_h} * a_.in_w * kStripBlock;
  }

  const InvertedResidualArgs& a_;
  std::int16_t* map_;  // starts with row `first_row_`
  std::int32_t first_row_ = 0;
  std::ptrdiff_t plane_elems_ = 0;
  float largest_ = 0.0f;
};

bool is_bounded(const ActivationSpec& activation) {
  const StripClamp clamp = clamp_of(activation);
  return clamp.low == 0.0f && clamp.high < __builtin_inff();
}

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  if (a.project.pairs != nullptr && is_bounded(a.depthwise.activation)) {
    InvertedResidual<QuantizedStrips>(a).run();
  } else {
    avx512::inverted_residual(a);
  }
}

}  // namespace mien::kernels::avx512vnni
