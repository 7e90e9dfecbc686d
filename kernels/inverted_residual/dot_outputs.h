// The outputs of products of 8-bit integers, for tiles of neondot and neoni8mm.
#pragma once

#include "kernels/common/neon_half.h"
#include "kernels/common/sized_tile.h"
#include "kernels/inverted_residual/dot_product.h"
#include "kernels/inverted_residual/inverted_residual.h"

namespace mien::kernels::MIEN_TIER {
namespace {

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

// A tile of pixels from x on times weights from w on.
template <class To>
using Run = void (*)(const DotProduct& a, const std::int8_t* x, const std::int8_t* w, const To& by,
                     typename To::Place at);

// All pixels of a block of 8 outputs, whose weights begin at w, from planes of kChannels channels.
template <int kChannels, class To>
void multiply_block(const DotProduct& a, const Tiling<Run<To>>& tiles, const std::int8_t* w,
                    const To& to) {
  const auto run = [&](const SizedTile<Run<To>>& tile, std::int32_t pixel) {
    tile.run(a, a.values + std::ptrdiff_t{pixel} * kChannels, w, to, to.at(pixel));
  };
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    run(tiles.each, i * tiles.each.pixels);
  }
  if (tiles.last.run != nullptr) {
    run(tiles.last, a.to.pixels - tiles.last.pixels);
  }
}

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
