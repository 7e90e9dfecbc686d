// Register tiles of up to 9 pixels x 16 outputs, or x 8 for a last block. fp16 weights are used as
// stored, multiplied by lane: nothing is converted to fp32, and no input is broadcast.
#include "kernels/inverted_residual/half_product.h"

#include <algorithm>
#include <utility>

#include "kernels/common/neon_half.h"
#include "kernels/common/product_sums.h"

namespace mien::kernels::neonfp16 {
namespace {

constexpr int kMaxPixels = 9;

struct Job {
  const Half* x;  // first pixel
  std::ptrdiff_t x_panel;
  std::int32_t in_blocks;
  const Half* w;      // [in][outputs]
  const Half* begin;  // initial sums, [outputs]
  float low, high;
  // Output: pixels are 16 apart, with an additional `gap` after each row. The first pixel is in
  // column `column`.
  Half* y;
  std::ptrdiff_t gap;
  std::int32_t column, row_pixels;
};

// Weights of one input.
template <int kVecs>
struct Row {
  HalfVec vecs[kVecs];
  [[gnu::always_inline]] explicit Row(const Half* w) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) { vecs[v] = load_halves(w + v * kHalves); }
  }
};

// Adds the products of an input to one of the partial sums.
template <int kLane, int kParts, int kPixels, int kVecs>
[[gnu::always_inline]] inline void add_input(const Row<kVecs>& row, const HalfVec (&x)[kPixels],
                                             HalfVec (&sums)[kParts][kPixels][kVecs]) {
  MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
    MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
      HalfVec& sum = sums[kLane % kParts][p][v];
      sum = fma_lane<kLane>(sum, row.vecs[v], x[p]);
    }
  }
}

// Adds inputs kLane to 7. The next weights are loaded first, because CPUs that execute in order
// wait for a load before its use.
template <int kLane, int kParts, int kPixels, int kVecs>
[[gnu::always_inline]] inline void add_inputs(const Half* w, const Row<kVecs>& row,
                                              const HalfVec (&x)[kPixels],
                                              HalfVec (&sums)[kParts][kPixels][kVecs]) {
  if constexpr (kLane == kBlock - 1) {
    add_input<kLane>(row, x, sums);
  } else {
    const Row<kVecs> next(w + (kLane + 1) * kVecs * kHalves);
    add_input<kLane>(row, x, sums);
    add_inputs<kLane + 1>(w, next, x, sums);
  }
}

// Adds a block of 8 inputs, in kParts partial sums.
template <int kParts, int kPixels, int kVecs>
[[gnu::always_inline]] inline void add_block(const Half* x, const Half* w,
                                             HalfVec (&sums)[kParts][kPixels][kVecs]) {
  const Row<kVecs> row(w);
  HalfVec inputs[kPixels];
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) { inputs[p] = load_halves(x + p * kPanel); }
  add_inputs<0>(w, row, inputs, sums);
}

template <int kPixels, int kVecs>
[[gnu::noinline]] void tile(const Job& j) {
  constexpr int kParts = partial_sums(kPixels * kVecs);
  HalfVec sums[kParts][kPixels][kVecs];
  MIEN_UNROLLED for (int i = 0; i < kParts * kPixels * kVecs; ++i) {
    const int part = i / (kPixels * kVecs), p = i / kVecs % kPixels, v = i % kVecs;
    sums[part][p][v] = part == 0 ? load_halves(j.begin + v * kHalves) : splat_halves(0.0f);
  }
  // Distances from the lower 8 channels of a panel to the upper, and from there to the next panel.
  std::ptrdiff_t step = kHalves, next_step = j.x_panel - kHalves;
  const Half *x = j.x, *w = j.w;
  for (std::int32_t left = j.in_blocks; left > 0; --left, w += kBlock * kVecs * kHalves) {
    add_block(x, w, sums);
    x += step;
    std::swap(step, next_step);
  }
  const HalfVec low = splat_halves(j.low), high = splat_halves(j.high);
  const std::ptrdiff_t gap = j.gap;
  const std::int32_t row_pixels = j.row_pixels;
  std::int32_t column = j.column;
  Half* y = j.y;
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p, y += kPanel) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      HalfVec total = sums[0][p][v];
      MIEN_UNROLLED for (int part = 1; part < kParts; ++part) {
        total = vaddq_f16(total, sums[part][p][v]);
      }
      store_halves(y + v * kHalves, vminq_f16(vmaxq_f16(total, low), high));
    }
    if (++column == row_pixels) {
      column = 0;
      y += gap;
    }
  }
}

struct Tile {
  std::int32_t pixels;
  void (*run)(const Job&);
};

// All tiles of `pixels` pixels have one size; if necessary, the last overlaps the previous one.
template <int kVecs, int... kSizes>
Tile tile_of(std::int32_t pixels, std::integer_sequence<int, kSizes...>) {
  const std::int32_t tiles = (pixels + kMaxPixels - 1) / kMaxPixels;
  const std::int32_t min_pixels = (pixels + tiles - 1) / tiles;
  Tile best{1, &tile<1, kVecs>};
  const auto consider = [&](Tile one) {
    best = one.pixels <= pixels && best.pixels < min_pixels ? one : best;
  };
  (consider({kSizes, &tile<kSizes, kVecs>}), ...);
  return best;
}

Tile tile_for(std::int32_t blocks, std::int32_t pixels) {
  return blocks == 2 ? tile_of<2>(pixels, std::integer_sequence<int, 2, 4, 6, 7, 8, 9>())
                     : tile_of<1>(pixels, std::integer_sequence<int, 4, 8, 9>());
}

// The 16 outputs from `block` on, or 8 at the end.
struct Group {
  std::int32_t block, blocks;
};

template <class Run>
void for_each_group(const HalfProduct& a, Run run) {
  for (std::int32_t block = 0; block < a.out_blocks; block += 2) {
    run(Group{block, std::min(2, a.out_blocks - block)});
  }
}

Job job_of(const HalfProduct& a, const Group& g) {
  Job job{};
  job.x_panel = a.x_panel_elems;
  job.in_blocks = a.in_blocks;
  job.w = a.weights + std::ptrdiff_t{g.block} * kBlock * a.in_blocks * kBlock;
  job.begin = a.bias + std::ptrdiff_t{g.block} * kBlock;
  return job;
}

void expand_group(const HalfProduct& a, const StripRows& to, const Group& g) {
  Job job = job_of(a, g);
  job.low = a.low;
  job.high = a.high;
  job.row_pixels = to.row_pixels;
  job.gap = to.row_elems - std::ptrdiff_t{to.row_pixels} * kPanel;
  const Tile tile = tile_for(g.blocks, a.pixels);
  for (std::int32_t done = 0; done < a.pixels; done += tile.pixels) {
    const std::int32_t pixel = std::min(done, a.pixels - tile.pixels);
    const std::int32_t row = pixel / to.row_pixels;
    job.column = pixel - row * to.row_pixels;
    job.x = a.x + std::ptrdiff_t{pixel} * kPanel;
    job.y = to.y + g.block / 2 * to.panel_elems + row * to.row_elems +
            std::ptrdiff_t{job.column} * kPanel;
    tile.run(job);
  }
}

// Sums of a tile, [pixels][16]: fp16 sums of the last products, and fp32 sums of all previous ones.
struct Totals {
  Half partial[kMaxPixels * kPanel];
  float sums[kMaxPixels * kPanel];
};

template <bool kIsFirst>
void add_partial(Totals& totals, std::int32_t pixels, std::int32_t blocks) {
  const Half* from = totals.partial;
  float* to = totals.sums;
  for (std::int32_t p = 0; p < pixels; ++p, from += kPanel, to += kPanel) {
    for (std::int32_t half = 0; half < blocks * kBlock; half += kBlock) {
      Pair sum = widened(load_halves(from + half));
      if (!kIsFirst) {
        const Pair before = load_pair(to + half);
        sum = {vaddq_f32(sum.low, before.low), vaddq_f32(sum.high, before.high)};
      }
      store_pair(to + half, sum);
    }
  }
}

// Stores the pixels from `first` on of one block.
void finish(const HalfProduct& a, const MapRows& to, std::int32_t block, std::int32_t first,
            std::int32_t pixels, const float* sums) {
  const Vec low = splat(a.low), high = splat(a.high);
  float* y = to.y + block * to.plane_elems + std::ptrdiff_t{first} * kBlock;
  const float* residual = to.residual == nullptr
                              ? nullptr
                              : to.residual + block * to.residual_plane_elems +
                                    first / to.row_pixels * to.residual_row_elems;
  std::int32_t column = first % to.row_pixels;
  for (std::int32_t p = 0; p < pixels; ++p, y += kBlock, sums += kPanel) {
    Pair value = load_pair(sums);
    value = {vminq_f32(vmaxq_f32(value.low, low), high),
             vminq_f32(vmaxq_f32(value.high, low), high)};
    if (residual != nullptr) {
      const Pair r = load_pair(residual + std::ptrdiff_t{column} * kBlock);
      value = {vaddq_f32(value.low, r.low), vaddq_f32(value.high, r.high)};
      if (++column == to.row_pixels) {
        column = 0;
        residual += to.residual_row_elems;
      }
    }
    store_pair(y, value);
  }
}

void project_tile(const HalfProduct& a, const MapRows& to, const Group& g, const Tile& tile,
                  std::int32_t pixel) {
  static constexpr Half kZeros[kPanel] = {};
  constexpr std::int32_t kBlocks = kHalfSum / kBlock;
  Job job = job_of(a, g);
  Totals totals;
  job.low = -__builtin_inff();
  job.high = __builtin_inff();
  job.x = a.x + std::ptrdiff_t{pixel} * kPanel;
  job.y = totals.partial;
  for (std::int32_t block = 0; block < a.in_blocks; block += kBlocks) {
    job.in_blocks = std::min(kBlocks, a.in_blocks - block);
    tile.run(job);
    (block == 0 ? add_partial<true> : add_partial<false>)(totals, tile.pixels, g.blocks);
    job.x += kHalfSum / kPanel * a.x_panel_elems;
    job.w += std::ptrdiff_t{kHalfSum} * g.blocks * kBlock;
    job.begin = kZeros;
  }
  for (std::int32_t half = 0; half < g.blocks; ++half) {
    finish(a, to, g.block + half, pixel, tile.pixels, totals.sums + half * kBlock);
  }
}

}  // namespace

void multiply_to_strip(const HalfProduct& a, const StripRows& to) {
  for_each_group(a, [&](const Group& g) { expand_group(a, to, g); });
}

void multiply_to_map(const HalfProduct& a, const MapRows& to) {
  for_each_group(a, [&](const Group& g) {
    const Tile tile = tile_for(g.blocks, a.pixels);
    for (std::int32_t done = 0; done < a.pixels; done += tile.pixels) {
      project_tile(a, to, g, tile, std::min(done, a.pixels - tile.pixels));
    }
  });
}

}  // namespace mien::kernels::neonfp16
