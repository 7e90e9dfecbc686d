// Register tiles of pixels x 16 output channels where the panel's weights, widened to fp32 once,
// fit into a small buffer; else of twice as many pixels x 8 channels. Products are taken by lane:
// no input is ever broadcast.
#include "kernels/common/neon_activation.h"
#include "kernels/common/neon_weights.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct Target {
  std::int32_t channel;  // first output channel, a multiple of 8
  std::int32_t pixel;    // first pixel
};

const float* residual_at(const PointwiseArgs& a, std::int32_t block, std::int32_t pixel) {
  const std::int32_t y = pixel / a.w + a.residual_top;
  const std::int32_t x = pixel % a.w + a.residual_left;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.residual_h} * a.residual_w;
  return a.residual + (block * plane + std::ptrdiff_t{y} * a.residual_w + x) * kBlock;
}

template <int kPixels, int kVecs>
[[gnu::always_inline]] inline void store(const PointwiseArgs& a, const Target& target,
                                         const Vec (&sums)[kPixels][kVecs]) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w;
  MIEN_UNROLLED for (int v = 0; v < kVecs; v += 2) {
    const std::int32_t block = target.channel / kBlock + v / 2;
    float* y = a.y + (block * plane + target.pixel) * kBlock;
    MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
      Pair value{sums[p][v], sums[p][v + 1]};
      if (a.residual != nullptr) {
        const Pair residual = load_pair(residual_at(a, block, target.pixel + p));
        value = {vaddq_f32(value.low, residual.low), vaddq_f32(value.high, residual.high)};
      }
      store_pair(y + p * kBlock, value);
    }
  }
}

template <int kPixels, int kVecs, class Source>
[[gnu::noinline]] void tile(const PointwiseArgs& a, const Activator& activator,
                            const Source& weights, const Target& target) {
  Vec sums[kPixels][kVecs];
  start_sums(a.bias + target.channel, sums);
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w * kBlock;
  const float* x = a.x + std::ptrdiff_t{target.pixel} * kBlock;
  const auto* w = weights.first;
  const std::ptrdiff_t row = weights.template row_elems<kVecs>();
  for (std::int32_t block = blocks_of(a.in_c); block > 0; --block, x += plane, w += kBlock * row) {
    add_four_inputs(x, kBlock, w, row, sums);
    add_four_inputs(x + kLanes, kBlock, w + kLanes * row, row, sums);
  }
  activator.apply(sums, target.channel);
  store(a, target, sums);
}

// The tile of `pixels` pixels, kLeast .. kMost.
template <int kLeast, int kMost, int kVecs, class Source>
void tile_of(const PointwiseArgs& a, const Activator& activator, const Source& weights,
             const Target& target, std::int32_t pixels) {
  if constexpr (kLeast < kMost) {
    if (pixels < kMost) {
      return tile_of<kLeast, kMost - 1, kVecs>(a, activator, weights, target, pixels);
    }
  }
  tile<kMost, kVecs>(a, activator, weights, target);
}

// Tiles of nearly equal size: 6 pixels are 3 + 3, not 5 + 1.
template <int kLeast, int kVecs, class Source>
void all_pixels(const PointwiseArgs& a, const Activator& activator, const Source& weights,
                std::int32_t channel) {
  constexpr int kMost = kTilePixels<kVecs>;
  const std::int32_t pixels = a.h * a.w;
  std::int32_t pixel = 0;
  for (std::int32_t left = (pixels + kMost - 1) / kMost; left > 0; --left) {
    const std::int32_t count = (pixels - pixel + left - 1) / left;
    tile_of<kLeast, kMost, kVecs>(a, activator, weights, {channel, pixel}, count);
    pixel += count;
  }
}

// More pixels than one tile has are at least half a tile each.
template <int kVecs>
void widened_outputs(const PointwiseArgs& a, const Activator& activator, const Halves& weights,
                     std::int32_t channel) {
  constexpr int kLeast = (kTilePixels<kVecs> + 1) / 2;
  float space[kWidenedElems];
  const Widened widened = widen<kVecs>(weights, blocks_of(a.in_c) * kBlock, space);
  all_pixels<kLeast, kVecs>(a, activator, widened, channel);
}

}  // namespace

void pointwise(const PointwiseArgs& a) {
  const Activator activator(a.activation, a.out_c);
  const std::ptrdiff_t rows = std::ptrdiff_t{blocks_of(a.in_c)} * kBlock;
  const std::int32_t padded = blocks_of(a.out_c) * kBlock;
  const bool several_tiles = a.h * a.w > kTilePixels<2>;
  for (std::int32_t channel = 0; channel < padded; channel += kPanel) {
    const std::int32_t width = padded - channel < kPanel ? kBlock : kPanel;
    const std::uint16_t* panel = a.weights + channel * rows;
    if (several_tiles && width == kPanel && fits_widened<4>(rows)) {
      widened_outputs<4>(a, activator, {panel, width}, channel);
      continue;
    }
    for (std::int32_t i = 0; i < width; i += kBlock) {
      const Halves weights{panel + i, width};
      if (several_tiles && fits_widened<2>(rows)) {
        widened_outputs<2>(a, activator, weights, channel + i);
      } else {
        all_pixels<1, 2>(a, activator, weights, channel + i);
      }
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
