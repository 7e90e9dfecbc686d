// Register tiles of up to 9 pixels x 8 outputs. SDOT multiplies 4 inputs of 4 outputs with 4 inputs
// of one pixel, so inputs need no broadcast. The outputs are the halves of a panel of 16, or a last
// panel of 8.
#include "kernels/common/neon_half.h"
#include "kernels/common/product_sums.h"
#include "kernels/common/sized_tile.h"
#include "kernels/inverted_residual/dot_product.h"
#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::kernels::neondot {
namespace {

constexpr int kVecs = kBlock / kLanes;
constexpr std::ptrdiff_t kQuad = 4;  // inputs that an instruction multiplies

// The weights of two quads of inputs, [quad][4 outputs], and their distance.
struct HalfPanel {
  static constexpr std::ptrdiff_t kStep = 2 * kQuad * kPanel;
  static void load(const std::int8_t* w, int8x16_t (&quads)[2][kVecs]) {
    MIEN_UNROLLED for (int i = 0; i < 2 * kVecs; ++i) {
      quads[i / kVecs][i % kVecs] =
          vld1q_s8(w + i / kVecs * kQuad * kPanel + i % kVecs * kQuad * kLanes);
    }
  }
};
struct LastPanel {
  static constexpr std::ptrdiff_t kStep = 2 * kQuad * kBlock;
  static void load(const std::int8_t* w, int8x16_t (&quads)[2][kVecs]) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      const int32x4x2_t both =
          vld2q_s32(reinterpret_cast<const std::int32_t*>(w + v * 2 * kQuad * kLanes));
      quads[0][v] = vreinterpretq_s8_s32(both.val[0]);
      quads[1][v] = vreinterpretq_s8_s32(both.val[1]);
    }
  }
};

// Writes pixels of a block of a strip: kPanel apart, with an additional `gap` after each row.
struct ToStrip {
  struct Place {
    Half* y;
    std::int32_t left;  // pixels of the row
  };
  Pair scale;
  HalfVec bias, low, high;
  Half* y;
  std::ptrdiff_t gap;
  std::int32_t row_pixels;

  ToStrip(const DotProduct& a, const StripRows& to, std::int32_t block)
      : bias(load_halves(a.to.bias + std::ptrdiff_t{block} * kBlock)),
        low(splat_halves(a.to.low)),
        high(splat_halves(a.to.high)),
        y(to.y + block / 2 * to.panel_elems + std::ptrdiff_t{block % 2} * kBlock),
        gap(to.row_elems - std::ptrdiff_t{to.row_pixels} * kPanel),
        row_pixels(to.row_pixels) {
    const Pair scales = load_pair(a.scales + std::ptrdiff_t{block} * kBlock);
    const Vec x_scale = splat(a.x_scale);
    scale = {vmulq_f32(scales.low, x_scale), vmulq_f32(scales.high, x_scale)};
  }
  [[nodiscard]] Place at(std::int32_t pixel) const {
    const std::int32_t row = pixel / row_pixels;
    return {y + std::ptrdiff_t{pixel} * kPanel + row * gap, (row + 1) * row_pixels - pixel};
  }
  [[gnu::always_inline]] void store(Pair sums, Place& at) const {
    const HalfVec product =
        to_half({vmulq_f32(sums.low, scale.low), vmulq_f32(sums.high, scale.high)});
    store_halves(at.y, vminq_f16(vmaxq_f16(vaddq_f16(product, bias), low), high));
    at.y += kPanel;
    if (--at.left == 0) {
      at.left = row_pixels;
      at.y += gap;
    }
  }
};

// Writes pixels of a block of a map.
struct ToMap {
  struct Place {
    float* y;
    const float* residual;
    std::int32_t left;  // pixels of the residual's row
  };
  Pair scale, bias;
  Vec low, high;
  float* y;
  const float* residual;  // nullptr: none
  std::ptrdiff_t residual_gap;
  std::int32_t row_pixels;

  ToMap(const DotProduct& a, const MapRows& to, std::int32_t block)
      : low(splat(a.to.low)),
        high(splat(a.to.high)),
        y(to.y + block * to.plane_elems),
        residual(to.residual == nullptr ? nullptr : to.residual + block * to.residual_plane_elems),
        residual_gap(to.residual_row_elems - std::ptrdiff_t{to.row_pixels} * kBlock),
        row_pixels(to.row_pixels) {
    const std::ptrdiff_t channel = std::ptrdiff_t{block} * kBlock;
    const Pair scales = load_pair(a.scales + channel), sums = load_pair(a.sums + channel);
    const Vec x_scale = splat(a.x_scale), shift = splat(kInt8Shift);
    scale = {vmulq_f32(scales.low, x_scale), vmulq_f32(scales.high, x_scale)};
    bias = load_half_pair(a.to.bias + channel);
    bias = {vfmaq_f32(bias.low, vmulq_f32(sums.low, shift), scale.low),
            vfmaq_f32(bias.high, vmulq_f32(sums.high, shift), scale.high)};
  }
  [[nodiscard]] Place at(std::int32_t pixel) const {
    Place place{y + std::ptrdiff_t{pixel} * kBlock, residual, 0};
    if (residual != nullptr) {
      const std::int32_t row = pixel / row_pixels;
      place.residual += std::ptrdiff_t{pixel} * kBlock + row * residual_gap;
      place.left = (row + 1) * row_pixels - pixel;
    }
    return place;
  }
  [[gnu::always_inline]] void store(Pair sums, Place& at) const {
    Pair value{vfmaq_f32(bias.low, sums.low, scale.low),
               vfmaq_f32(bias.high, sums.high, scale.high)};
    value = {vminq_f32(vmaxq_f32(value.low, low), high),
             vminq_f32(vmaxq_f32(value.high, low), high)};
    if (at.residual != nullptr) {
      const Pair r = load_pair(at.residual);
      value = {vaddq_f32(value.low, r.low), vaddq_f32(value.high, r.high)};
      at.residual += kBlock;
      if (--at.left == 0) {
        at.left = row_pixels;
        at.residual += residual_gap;
      }
    }
    store_pair(at.y, value);
    at.y += kBlock;
  }
};

// Adds the products of a quad of inputs: of all pixels, because each sum waits for its previous
// one.
template <int kLane, int kPixels, int kParts>
[[gnu::always_inline]] inline void add_quad(const int8x16_t (&w)[kVecs],
                                            const int8x16_t (&x)[kPixels],
                                            int32x4_t (&sums)[kParts][kPixels][kVecs]) {
  MIEN_UNROLLED for (int i = 0; i < kPixels * kVecs; ++i) {
    const int p = i / kVecs, v = i % kVecs;
    int32x4_t& sum = sums[kLane % kParts][p][v];
    sum = vdotq_laneq_s32(sum, w[v], x[p], kLane);
  }
}

template <int kPixels>
[[gnu::always_inline]] inline void load_pixels(const std::int8_t* x, int8x16_t (&y)[kPixels]) {
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) { y[p] = vld1q_s8(x + p * kPanel); }
}

template <class Panel, class To, int kPixels>
[[gnu::noinline]] void tile(const DotProduct& a, const std::int8_t* x, const std::int8_t* w,
                            const To& by, typename To::Place at) {
  constexpr int kParts = partial_sums(kPixels * kVecs);
  int32x4_t sums[kParts][kPixels][kVecs];
  MIEN_UNROLLED for (int i = 0; i < kParts * kPixels * kVecs; ++i) {
    sums[i / (kPixels * kVecs)][i / kVecs % kPixels][i % kVecs] = vdupq_n_s32(0);
  }
  const std::ptrdiff_t step = a.block_elems;
  for (std::int32_t left = a.to.in_blocks / 2; left > 0; --left, w += 2 * Panel::kStep, x += step) {
    int8x16_t values[kPixels], quads[2][kVecs];
    load_pixels(x, values);
    Panel::load(w, quads);
    add_quad<0>(quads[0], values, sums);
    add_quad<1>(quads[1], values, sums);
    Panel::load(w + Panel::kStep, quads);
    add_quad<2>(quads[0], values, sums);
    add_quad<3>(quads[1], values, sums);
  }
  if (a.to.in_blocks % 2 != 0) {
    int8x16_t values[kPixels], quads[2][kVecs];
    load_pixels(x, values);
    Panel::load(w, quads);
    add_quad<0>(quads[0], values, sums);
    add_quad<1>(quads[1], values, sums);
  }
  const To to = by;
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
    int32x4_t total[kVecs];
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      total[v] = sums[0][p][v];
      MIEN_UNROLLED for (int part = 1; part < kParts; ++part) {
        total[v] = vaddq_s32(total[v], sums[part][p][v]);
      }
    }
    to.store({vcvtq_f32_s32(total[0]), vcvtq_f32_s32(total[1])}, at);
  }
}

template <class To>
using Run = void (*)(const DotProduct& a, const std::int8_t* x, const std::int8_t* w, const To& by,
                     typename To::Place at);

template <class Panel, class To, int... kSizes>
Tiling<Run<To>> tiling_of_sizes(std::int32_t pixels) {
  static constexpr SizedTile<Run<To>> kTiles[] = {{kSizes, &tile<Panel, To, kSizes>}...};
  return tiling_of(kTiles, pixels);
}
template <class Panel, class To>
Tiling<Run<To>> tiles_for(std::int32_t pixels) {
  return tiling_of_sizes<Panel, To, 1, 2, 4, 6, 8, 9>(pixels);
}

// All pixels of a block of 8 outputs, whose weights begin at w.
template <class To>
void multiply_block(const DotProduct& a, const Tiling<Run<To>>& tiles, const std::int8_t* w,
                    const To& to) {
  const auto run = [&](const SizedTile<Run<To>>& tile, std::int32_t pixel) {
    tile.run(a, a.values + std::ptrdiff_t{pixel} * kPanel, w, to, to.at(pixel));
  };
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    run(tiles.each, i * tiles.each.pixels);
  }
  if (tiles.last.run != nullptr) {
    run(tiles.last, a.to.pixels - tiles.last.pixels);
  }
}

template <class To, class Rows>
void multiply(const DotProduct& a, const Rows& rows) {
  const std::int32_t whole = a.to.out_blocks / 2 * 2;  // blocks of panels of 16
  const std::ptrdiff_t block_bytes = std::ptrdiff_t{(a.to.in_blocks + 1) / 2} * kPanel * kBlock;
  const auto tiles = tiles_for<HalfPanel, To>(a.to.pixels);
  for (std::int32_t block = 0; block < whole; ++block) {
    const std::int32_t half = block % 2;
    multiply_block(a, tiles, a.quads + (block - half) * block_bytes + half * kQuad * kBlock,
                   To(a, rows, block));
  }
  if (whole < a.to.out_blocks) {
    multiply_block(a, tiles_for<LastPanel, To>(a.to.pixels), a.quads + whole * block_bytes,
                   To(a, rows, whole));
  }
}

}  // namespace

void multiply_to_strip(const DotProduct& a, const StripRows& to) { multiply<ToStrip>(a, to); }
void multiply_to_map(const DotProduct& a, const MapRows& to) { multiply<ToMap>(a, to); }

}  // namespace mien::kernels::neondot
