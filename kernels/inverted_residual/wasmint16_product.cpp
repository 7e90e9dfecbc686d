// The products of the wasmint16 tier: register tiles of up to 5 pixels x half a panel, 2 vectors.
// Each lane multiplies two integers of 16 bits at once. A last panel of 8 multiplies 4 elements of
// the sum of each output, 2 in the even lanes and 2 in the odd.
#include "kernels/common/pixel_pointer.h"
#include "kernels/common/sized_tile.h"
#include "kernels/common/wasm_weights.h"
#include "kernels/inverted_residual/quantized_product.h"

namespace mien::kernels::wasmint16 {
namespace {

using wasm::add_product;
using wasm::kBlock;
using wasm::kLanes;
using wasm::kPanel;
using wasm::load_half;
using wasm::max;
using wasm::min;
using wasm::splat;
using wasm::Vec;

constexpr int kVecs = 2;
constexpr int kMaxPixels = 5;  // of 16 registers, the sums use ten
constexpr std::ptrdiff_t kHalfPanel = 8 * kVecs, kStepElems = 2 * kPanel;  // integers

struct Sums {
  Vec of[kMaxPixels][kVecs];
};

// kCount 1: a panel of 16 outputs, 2: a last panel of 8.
template <int kCount>
Vec broadcast_pairs(const std::int16_t* x) {
  return kCount == 1 ? wasm_v128_load32_splat(x) : wasm_v128_load64_splat(x);
}

template <int kPixels, int kCount>
[[gnu::noinline]] void sums_of(const QuantizedProduct& a, const std::int16_t* x,
                               const std::int16_t* w, Sums& to) {
  Vec sum[kPixels][kVecs];
  for (auto& pixel : sum) {
    for (Vec& one : pixel) {
      one = wasm_i32x4_splat(0);
    }
  }
  for (std::int32_t left = a.to.in_blocks; left > 0; --left, x += a.plane_elems) {
    for (int lane = 0; lane < kBlock; lane += 2 * kCount, w += kStepElems) {
      const Vec weight[kVecs] = {wasm_v128_load(w), wasm_v128_load(w + kStepElems / 4)};
      for (int p = 0; p < kPixels; ++p) {
        const Vec value = broadcast_pairs<kCount>(x + p * kBlock + lane);
        for (int v = 0; v < kVecs; ++v) {
          sum[p][v] = wasm_i32x4_add(sum[p][v], wasm_i32x4_dot_i16x8(value, weight[v]));
        }
      }
    }
  }
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      to.of[p][v] = sum[p][v];
    }
  }
}

// Converts the sums of 4 outputs to results.
struct Finish {
  Vec scale, bias;

  Finish(const QuantizedProduct& a, std::ptrdiff_t channel)
      : scale(wasm_f32x4_mul(wasm::load(a.scales + channel), splat(a.x_scale))),
        bias(load_half(a.to.bias + channel)) {}

  [[nodiscard]] Vec of(Vec sum) const {
    return add_product(bias, wasm_f32x4_convert_i32x4(sum), scale);
  }
};

inline Vec sum_of_pairs(const Vec (&sums)[kVecs]) {
  return wasm_i32x4_add(wasm_i32x4_shuffle(sums[0], sums[1], 0, 2, 4, 6),
                        wasm_i32x4_shuffle(sums[0], sums[1], 1, 3, 5, 7));
}

// Half of the outputs of one panel.
template <int kCount>
class HalfPanel {
 public:
  // `half`: 0 or 1
  HalfPanel(const QuantizedProduct& product, std::int32_t panel, std::int32_t half)
      : a_(product),
        panel_(panel),
        half_(half),
        weights_(product.pairs + std::ptrdiff_t{panel} * product.to.in_blocks * kBlock * kPanel +
                 half * kHalfPanel) {}

  void multiply() const {
    static constexpr SizedTile<Run> kTiles[] = {{1, &sums_of<1, kCount>},
                                                {2, &sums_of<2, kCount>},
                                                {3, &sums_of<3, kCount>},
                                                {4, &sums_of<4, kCount>},
                                                {5, &sums_of<5, kCount>}};
    const Tiling<Run> tiles = tiling_of(kTiles, a_.to.pixels);
    run(tiles.each, 0, tiles.each.pixels * tiles.count);
    if (tiles.last.run != nullptr) {
      run(tiles.last, a_.to.pixels - tiles.last.pixels, a_.to.pixels);
    }
  }

 private:
  using Run = void (*)(const QuantizedProduct&, const std::int16_t* x, const std::int16_t* w,
                       Sums&);

  // Computes pixels [first, end) in tiles of one size.
  void run(const SizedTile<Run>& tile, std::int32_t first, std::int32_t end) const {
    a_.to.residual != nullptr ? run_tiles<true>(tile, first, end)
                              : run_tiles<false>(tile, first, end);
  }

  template <bool kResidual>
  void run_tiles(const SizedTile<Run>& tile, std::int32_t first, std::int32_t end) const {
    constexpr std::int32_t kOutputs = kBlock / kCount;
    const std::ptrdiff_t channel = std::ptrdiff_t{panel_} * kPanel + half_ * kOutputs;
    const Finish finish[kVecs] = {Finish(a_, channel),
                                  Finish(a_, kCount == 1 ? channel + kLanes : channel)};
    const Vec low = splat(a_.to.low), high = splat(a_.to.high);
    PixelPointer<float> y(a_.to.y + first_lane(a_.to.y_rows), a_.to.y_rows, panel_, first);
    PixelPointer<const float> residual;
    if constexpr (kResidual) {
      const PixelRows& rows = a_.to.residual_rows;
      residual = PixelPointer(a_.to.residual + first_lane(rows), rows, panel_, first);
    }
    for (std::int32_t pixel = first; pixel < end; pixel += tile.pixels) {
      Sums sums;
      tile.run(a_, a_.values + std::ptrdiff_t{pixel} * kBlock, weights_, sums);
      for (std::int32_t p = 0; p < tile.pixels; ++p, y.advance()) {
        for (int v = 0; v < kOutputs / kLanes; ++v) {
          const Vec sum = kCount == 1 ? sums.of[p][v] : sum_of_pairs(sums.of[p]);
          Vec value = min(max(finish[v].of(sum), low), high);
          if constexpr (kResidual) {
            value = wasm_f32x4_add(value, wasm::load(residual.at + v * kLanes));
          }
          wasm::store(y.at + v * kLanes, value);
        }
        if constexpr (kResidual) {
          residual.advance();
        }
      }
    }
  }

  // Of this half, in a pixel of its panel.
  [[nodiscard]] std::ptrdiff_t first_lane(const PixelRows& rows) const {
    return half_ * (kCount == 1 ? rows.half_elems : std::ptrdiff_t{kLanes});
  }

  const QuantizedProduct& a_;
  std::int32_t panel_, half_;
  const std::int16_t* weights_;
};

template <int kPixels>
void float_tile(const ProductArgs& a, const wasm::Halves& weights, std::int32_t block,
                std::int32_t pixel) {
  Vec sums[kPixels][kVecs];
  wasm::start_sums(a.bias + std::ptrdiff_t{block} * kBlock, sums);
  const float* x = a.x + std::ptrdiff_t{pixel} * kBlock;
  const std::uint16_t* w = weights.first;
  for (std::int32_t left = a.in_blocks; left > 0; --left, x += a.x_plane_elems) {
    for (int lane = 0; lane < kBlock; ++lane, w += weights.stride) {
      wasm::add_input(x + lane, kBlock, w, sums);
    }
  }
  const std::int32_t panel = block / 2, half = block % 2;
  PixelPointer<float> y(a.y, a.y_rows, panel, pixel);
  auto residual = PixelPointer<const float>::optional(a.residual, a.residual_rows, panel, pixel);
  for (int p = 0; p < kPixels; ++p, y.advance()) {
    for (int v = 0; v < kVecs; ++v) {
      Vec value = min(max(sums[p][v], splat(a.low)), splat(a.high));
      if (residual.at != nullptr) {
        value = wasm_f32x4_add(value, wasm::load(residual.at + half * residual.half + v * kLanes));
      }
      wasm::store(y.at + half * y.half + v * kLanes, value);
    }
    if (residual.at != nullptr) {
      residual.advance();
    }
  }
}

}  // namespace

void multiply_quantized(const QuantizedProduct& a) {
  const std::int32_t panels = a.to.out_blocks / 2;
  for (std::int32_t half = 0; half < 2; ++half) {
    for (std::int32_t panel = 0; panel < panels; ++panel) {
      HalfPanel<1>(a, panel, half).multiply();
    }
    if (a.to.out_blocks % 2 != 0) {
      HalfPanel<2>(a, panels, half).multiply();
    }
  }
}

void multiply_floats(const ProductArgs& a) {
  constexpr std::int32_t kPixels = 4;
  for (std::int32_t block = 0; block < a.out_blocks; ++block) {
    const std::int32_t half = block % 2, first = block - half;
    const std::int32_t width = first + 1 < a.out_blocks ? kPanel : kBlock;
    const wasm::Halves weights{
        a.weights + std::ptrdiff_t{first} * a.in_blocks * kBlock * kBlock + half * kBlock, width};
    std::int32_t pixel = 0;
    for (; pixel + kPixels <= a.pixels; pixel += kPixels) {
      float_tile<kPixels>(a, weights, block, pixel);
    }
    for (; pixel < a.pixels; ++pixel) {
      float_tile<1>(a, weights, block, pixel);
    }
  }
}

}  // namespace mien::kernels::wasmint16
