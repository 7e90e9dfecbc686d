// Register tiles of pixels x 16 output channels if the panel's weights, converted to fp32 once, fit
// the buffer; otherwise of twice as many pixels x 8 channels. Products are by lane: no input is
// broadcast.
#include <algorithm>
#include <type_traits>
#include <utility>

#include "kernels/common/neon_weights.h"
#include "kernels/common/product.h"
#include "kernels/common/product_sums.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Iterates over pixels in rows.
struct Cursor {
  std::ptrdiff_t at;
  std::int32_t column;

  Cursor(const PixelRows& rows, std::int32_t pixel)
      : at(pixel * rows.pixel_elems + pixel / rows.row_pixels * rows.row_gap_elems),
        column(pixel % rows.row_pixels) {}
  void advance(const PixelRows& rows) {
    at += rows.pixel_elems;
    if (++column == rows.row_pixels) {
      column = 0;
      at += rows.row_gap_elems;
    }
  }
};

// A sweep over the pixels for one tile width of output channels.
struct Sweep {
  const ProductArgs& a;
  const std::uint16_t* bias;
  float* y;               // first pixel
  const float* residual;  // first pixel; nullptr: none
};

template <int kPixels, int kVecs, class Source>
[[gnu::noinline]] void tile(const Sweep& s, const Source& weights, std::int32_t first) {
  constexpr int kParts = partial_sums(kPixels * kVecs);
  const ProductArgs& a = s.a;
  Vec sums[kParts][kPixels][kVecs];
  start_sums(s.bias, sums);
  const float* x = a.x + std::ptrdiff_t{first} * kBlock;
  const auto* w = weights.first;
  const std::ptrdiff_t row = weights.template row_elems<kVecs>();
  for (std::int32_t block = a.in_blocks; block > 0; --block, w += kBlock * row) {
    add_four_inputs(x, kBlock, w, row, sums);
    add_four_inputs(x + kLanes, kBlock, w + kLanes * row, row, sums);
    x += a.x_plane_elems;
  }
  // Copies, which stores cannot alias, stay in registers.
  const Vec low = splat(a.low), high = splat(a.high);
  const PixelRows rows = a.y_rows;
  float* const y = s.y;
  Cursor pixel(rows, first);
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p, pixel.advance(rows)) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      Vec& total = sums[0][p][v];
      MIEN_UNROLLED for (int part = 1; part < kParts; ++part) {
        total = vaddq_f32(total, sums[part][p][v]);
      }
      total = vminq_f32(vmaxq_f32(total, low), high);
    }
    MIEN_UNROLLED for (int half = 0; half < kVecs / 2; ++half) {
      store_pair(y + pixel.at + half * rows.half_elems,
                 {sums[0][p][2 * half], sums[0][p][2 * half + 1]});
    }
  }
}

// Adds the residual to the `pixels` that a tile has stored. A separate pass needs less code than
// every tile.
template <int kVecs>
void add_residual(const Sweep& s, std::int32_t first, std::int32_t pixels) {
  const PixelRows y_rows = s.a.y_rows, residual_rows = s.a.residual_rows;
  Cursor y(y_rows, first), r(residual_rows, first);
  for (std::int32_t p = 0; p < pixels; ++p, y.advance(y_rows), r.advance(residual_rows)) {
    MIEN_UNROLLED for (int half = 0; half < kVecs / 2; ++half) {
      float* to = s.y + y.at + half * y_rows.half_elems;
      const Pair value = load_pair(to);
      const Pair more = load_pair(s.residual + r.at + half * residual_rows.half_elems);
      store_pair(to, {vaddq_f32(value.low, more.low), vaddq_f32(value.high, more.high)});
    }
  }
}

template <class Source>
struct Tile {
  std::int32_t pixels;
  void (*run)(const Sweep&, const Source&, std::int32_t first);
};

// The available tile sizes. Weights are converted only for several tiles; all of these have at
// least half of the largest size.
template <int... kPixels>
using Sizes = std::integer_sequence<int, kPixels...>;
#ifdef MIEN_NEON64
template <int kVecs>
using WidenedSizes = std::conditional_t<kVecs == 4, Sizes<3, 4, 5>, Sizes<5, 7, 9>>;
using HalvesSizes = Sizes<1, 2, 3, 4, 6, 9>;
#else
template <int kVecs>
using WidenedSizes = std::conditional_t<kVecs == 4, Sizes<1, 2>, Sizes<2, 4>>;
using HalvesSizes = Sizes<1, 2, 4>;  // 3 would not fit the registers
#endif

// All tiles of `pixels` pixels have one size; if necessary, the last overlaps the previous one.
template <int kVecs, class Source, int... kSizes>
Tile<Source> tile_of(std::int32_t pixels, Sizes<kSizes...>) {
  const std::int32_t tiles = (pixels + kTilePixels<kVecs> - 1) / kTilePixels<kVecs>;
  const std::int32_t min_pixels = (pixels + tiles - 1) / tiles;
  Tile<Source> best{};
  const auto consider = [&](Tile<Source> one) {
    best = one.pixels <= pixels && best.pixels < min_pixels ? one : best;
  };
  (consider({kSizes, &tile<kSizes, kVecs, Source>}), ...);
  return best;
}
template <int kVecs>
Tile<Widened> tile_for(std::int32_t pixels, const Widened&) {
  return tile_of<kVecs, Widened>(pixels, WidenedSizes<kVecs>());
}
template <int kVecs>
Tile<Halves> tile_for(std::int32_t pixels, const Halves&) {
  return tile_of<kVecs, Halves>(pixels, HalvesSizes());
}

// Computes output channels from `block` on.
template <int kVecs, class Source>
void sweep(const ProductArgs& a, std::int32_t block, const Source& weights) {
  const auto begin = [block](const PixelRows& rows) {
    return block / 2 * rows.panel_elems + block % 2 * rows.half_elems;
  };
  const Sweep s{a, a.bias + std::ptrdiff_t{block} * kBlock, a.y + begin(a.y_rows),
                a.residual == nullptr ? nullptr : a.residual + begin(a.residual_rows)};
  const Tile<Source> tile = tile_for<kVecs>(a.pixels, weights);
  for (std::int32_t done = 0; done < a.pixels; done += tile.pixels) {
    const std::int32_t first = std::min(done, a.pixels - tile.pixels);
    tile.run(s, weights, first);
    if (s.residual != nullptr) {
      add_residual<kVecs>(s, first, tile.pixels);
    }
  }
}

// Buffer for weights in fp32.
struct Space {
  float* first;
  std::ptrdiff_t elems;
};

void run_panel(const ProductArgs& a, std::int32_t block, std::int32_t width, const Space& space) {
  const std::ptrdiff_t rows = std::ptrdiff_t{a.in_blocks} * kBlock;
  const std::uint16_t* panel = a.weights + block * kBlock * rows;
  const bool several_tiles = a.pixels > kTilePixels<2>;
  if (several_tiles && width == kPanel && rows * kPanel <= space.elems) {
    return sweep<4>(a, block, widen<4>({panel, width}, rows, space.first));
  }
  for (std::int32_t i = 0; i < width; i += kBlock, ++block) {
    const Halves weights{panel + i, width};
    if (several_tiles && rows * kBlock <= space.elems) {
      sweep<2>(a, block, widen<2>(weights, rows, space.first));
    } else {
      sweep<2>(a, block, weights);
    }
  }
}

}  // namespace

void multiply_panels(const ProductArgs& a) {
  float own[kWidenedElems];
  const Space space = a.fp32_weights == nullptr ? Space{own, kWidenedElems}
                                                : Space{a.fp32_weights, kFp32WeightElems};
  for (std::int32_t block = 0; block < a.out_blocks; block += 2) {
    run_panel(a, block, block + 1 < a.out_blocks ? kPanel : kBlock, space);
  }
}

}  // namespace mien::kernels::MIEN_TIER
