// Register tiles of pixels x vectors of 4 output channels. WebAssembly has no multiply by lane, so
// every input is broadcast, and converting a weight to fp32 costs as much as two multiply-adds. If
// a panel's weights fit a small buffer, they are converted once for all tiles. Otherwise tiles are
// narrow and have many pixels, so that each converted weight serves many of them.
#include "kernels/common/wasm_activation.h"
#include "kernels/common/wasm_weights.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

// Of 16 registers, the sums use ten; the others hold weights, an input and a product.
constexpr int kNarrowPixels = 10;  // x 1 vector
constexpr int kWidePixels = 5;     // x 2 vectors
constexpr int kFewPixels = 2;      // x 4 vectors

struct Target {
  std::int32_t channel;  // first output channel, a multiple of 4
  std::int32_t pixel;    // first pixel
};

const float* residual_at(const PointwiseArgs& a, std::int32_t channel, std::int32_t pixel) {
  const std::int32_t y = pixel / a.w + a.residual_top;
  const std::int32_t x = pixel % a.w + a.residual_left;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.residual_h} * a.residual_w;
  return a.residual + channel % kBlock +
         (channel / kBlock * plane + std::ptrdiff_t{y} * a.residual_w + x) * kBlock;
}

template <int kPixels, int kVecs>
inline void store_sums(const PointwiseArgs& a, const Activator& activator, const Target& target,
                       const Vec (&sums)[kPixels][kVecs]) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w;
  for (int v = 0; v < kVecs; ++v) {
    const std::int32_t channel = target.channel + v * kLanes;
    float* y = a.y + (channel / kBlock * plane + target.pixel) * kBlock + channel % kBlock;
    for (int p = 0; p < kPixels; ++p) {
      Vec value = activator.clamped(sums[p][v]);
      if (a.residual != nullptr && !activator.curves()) {
        value = wasm_f32x4_add(value, load(residual_at(a, channel, target.pixel + p)));
      }
      store(y + p * kBlock, value);
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
  for (std::int32_t block = blocks_of(a.in_c); block > 0; --block, x += plane) {
    for (int lane = 0; lane < kBlock; ++lane, w += row) {
      add_input(x + lane, kBlock, w, sums);
    }
  }
  store_sums(a, activator, target, sums);
}

// Applies what tiles leave out: curves, then residuals.
void curve_and_add(const PointwiseArgs& a, const Activator& activator, std::int32_t channel) {
  const std::int32_t pixels = a.h * a.w;
  float* y = a.y + std::ptrdiff_t{channel / kBlock} * pixels * kBlock + channel % kBlock;
  activator.curve_channels(y, pixels, channel);
  for (std::int32_t p = 0; a.residual != nullptr && p < pixels; ++p, y += kBlock) {
    store(y, wasm_f32x4_add(load(y), load(residual_at(a, channel, p))));
  }
}

// Runs the tile of `pixels` pixels, kMin .. kMax.
template <int kMin, int kMax, int kVecs, class Source>
void tile_of(const PointwiseArgs& a, const Activator& activator, const Source& weights,
             const Target& target, std::int32_t pixels) {
  if constexpr (kMin < kMax) {
    if (pixels < kMax) {
      return tile_of<kMin, kMax - 1, kVecs>(a, activator, weights, target, pixels);
    }
  }
  tile<kMax, kVecs>(a, activator, weights, target);
}

// Splits the pixels into tiles of nearly equal size, each with at least kMin pixels.
template <int kMin, int kMax, int kVecs, class Source>
void all_pixels(const PointwiseArgs& a, const Activator& activator, const Source& weights,
                std::int32_t channel) {
  const std::int32_t pixels = a.h * a.w;
  std::int32_t pixel = 0;
  for (std::int32_t left = (pixels + kMax - 1) / kMax; left > 0; --left) {
    const std::int32_t count = (pixels - pixel + left - 1) / left;
    tile_of<kMin, kMax, kVecs>(a, activator, weights, {channel, pixel}, count);
    pixel += count;
  }
}

// Computes kVecs vectors of outputs from `channel` on, for more pixels than one tile has: each tile
// has at least half of the maximum.
template <int kMax, int kVecs>
void widened_outputs(const PointwiseArgs& a, const Activator& activator, const Halves& weights,
                     std::int32_t channel) {
  float space[kWidenedElems];
  const Widened widened = widen<kVecs>(weights, blocks_of(a.in_c) * kBlock, space);
  all_pixels<(kMax + 1) / 2, kMax, kVecs>(a, activator, widened, channel);
}

// Computes a block of outputs with the given weights.
void block_of_outputs(const PointwiseArgs& a, const Activator& activator, const Halves& weights,
                      std::int32_t channel) {
  const std::ptrdiff_t rows = std::ptrdiff_t{blocks_of(a.in_c)} * kBlock;
  const std::int32_t pixels = a.h * a.w;
  const Halves upper{weights.first + kLanes, weights.stride};
  if (pixels <= kWidePixels) {
    all_pixels<1, kWidePixels, 2>(a, activator, weights, channel);
  } else if (pixels <= kNarrowPixels || !fits_widened<1>(rows)) {
    all_pixels<kWidePixels, kNarrowPixels, 1>(a, activator, weights, channel);
    all_pixels<kWidePixels, kNarrowPixels, 1>(a, activator, upper, channel + kLanes);
  } else if (fits_widened<2>(rows)) {
    widened_outputs<kWidePixels, 2>(a, activator, weights, channel);
  } else {
    widened_outputs<kNarrowPixels, 1>(a, activator, weights, channel);
    widened_outputs<kNarrowPixels, 1>(a, activator, upper, channel + kLanes);
  }
}

}  // namespace

void pointwise(const PointwiseArgs& a) {
  const Activator activator(a.activation, a.out_c);
  const std::ptrdiff_t rows = std::ptrdiff_t{blocks_of(a.in_c)} * kBlock;
  const std::int32_t padded = blocks_of(a.out_c) * kBlock;
  for (std::int32_t channel = 0; channel < padded; channel += kPanel) {
    const std::int32_t width = padded - channel < kPanel ? kBlock : kPanel;
    const Halves weights{a.weights + channel * rows, width};
    if (width == kPanel && a.h * a.w <= kFewPixels) {
      all_pixels<1, kFewPixels, 4>(a, activator, weights, channel);
      continue;
    }
    for (std::int32_t i = 0; i < width; i += kBlock) {
      block_of_outputs(a, activator, {weights.first + i, width}, channel + i);
    }
  }
  for (std::int32_t channel = 0; activator.curves() && channel < padded; channel += kLanes) {
    curve_and_add(a, activator, channel);
  }
}

}  // namespace mien::kernels::wasm
