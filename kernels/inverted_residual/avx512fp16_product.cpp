// Register tiles of up to 14 pixels x 2 vectors of 32 outputs, 9 x 3 or 6 x 4, limited by the
// number of registers. For 16 remaining outputs each vector holds two elements of the sum per
// output, for 8 four: that many values of x are broadcast together, and weights are permuted
// accordingly.
#include "kernels/inverted_residual/half_product.h"

#include <immintrin.h>

#include <algorithm>

#include "kernels/common/avx512.h"
#include "kernels/common/sized_tile.h"

namespace mien::kernels::avx512fp16 {
namespace {

using Vec = __m512h;

constexpr int kMaxVecs = 4;
constexpr int kMaxSums = 28;  // pixels times vectors of a tile
constexpr std::int32_t kPanel = 16;
static_assert(kSumsElems == kMaxSums * kHalves * 3 / 2);  // fp32 and fp16

Vec load(const Half* at) { return _mm512_loadu_ph(at); }
Vec set(float value) { return _mm512_set1_ph(static_cast<_Float16>(value)); }

// Contents of a vector of sums.
enum class Lanes {
  k32,     // 32 outputs, two panels of weights
  kSome,   // the same, but some of them do not exist
  kPairs,  // 16 outputs, even and odd elements of the sum: one panel
  kQuads,  // 8 outputs, four elements: the last panel, of 8
};

// A part of the products of one tile.
struct Job {
  const Half* x;
  std::ptrdiff_t x_panel;
  std::int32_t in_blocks;
  const Half* w;            // first panel of weights
  std::ptrdiff_t panel;     // distance between panels of weights
  std::int32_t out_blocks;  // kSome: 1 to 3
  const Half* begin;        // initial sums, `[vecs][32]`
  Vec low, high;
  // Output: vectors are `y_vec` apart, pixels 32, with an additional `gap` after each row. The
  // first pixel is in column `column`.
  Half* y;
  std::ptrdiff_t y_vec, gap;
  std::int32_t column, row_pixels;  // row_pixels 0: a single row
};

// Number of elements of a sum in a vector.
template <Lanes kLanes>
constexpr int kAtOnce = kLanes == Lanes::kPairs   ? 2
                        : kLanes == Lanes::kQuads ? 4
                                                  : 1;

__m256i load_panel(const Half* at) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
}

Vec joined(__m256i low, __m256i high) {
  return _mm512_castsi512_ph(_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1));
}

// Reorders w0 of all outputs, w1 of all outputs, .. to w0, w1, .. of each output.
template <Lanes kLanes>
__m512i side_by_side() {
  if constexpr (kLanes == Lanes::kPairs) {
    return _mm512_set_epi16(31, 15, 30, 14, 29, 13, 28, 12, 27, 11, 26, 10, 25, 9, 24, 8, 23, 7, 22,
                            6, 21, 5, 20, 4, 19, 3, 18, 2, 17, 1, 16, 0);
  } else {
    return _mm512_set_epi16(31, 23, 15, 7, 30, 22, 14, 6, 29, 21, 13, 5, 28, 20, 12, 4, 27, 19, 11,
                            3, 26, 18, 10, 2, 25, 17, 9, 1, 24, 16, 8, 0);
  }
}

// Loads the weights of elements k .. k + kAtOnce - 1 of the sum, for the outputs of vector `vec`.
template <Lanes kLanes>
Vec weights_at(const Job& j, int vec, std::ptrdiff_t k) {
  if constexpr (kLanes == Lanes::k32) {
    const Half* w = j.w + k * kPanel + 2 * vec * j.panel;
    return joined(load_panel(w), load_panel(w + j.panel));
  } else if constexpr (kLanes == Lanes::kSome) {
    const bool whole = j.out_blocks > 1;
    const __m256i low = _mm256_maskz_loadu_epi16(whole ? 0xFFFF : 0xFF, j.w + k * (whole ? 16 : 8));
    const __mmask16 more = j.out_blocks > 2 ? 0xFF : 0;
    return joined(low, _mm256_maskz_loadu_epi16(more, j.w + j.panel + k * 8));
  } else {
    const __m512i w = _mm512_loadu_si512(j.w + k * (kHalves / kAtOnce<kLanes>));
    return _mm512_castsi512_ph(_mm512_permutexvar_epi16(side_by_side<kLanes>(), w));
  }
}

template <Lanes kLanes>
Vec broadcast(const Half* x) {
  if constexpr (kLanes == Lanes::kPairs) {
    int pair;
    __builtin_memcpy(&pair, x, sizeof pair);
    return _mm512_castsi512_ph(_mm512_set1_epi32(pair));
  } else if constexpr (kLanes == Lanes::kQuads) {
    long long four;
    __builtin_memcpy(&four, x, sizeof four);
    return _mm512_castsi512_ph(_mm512_set1_epi64(four));
  } else {
    return _mm512_castsi512_ph(_mm512_set1_epi16(static_cast<short>(*x)));
  }
}

template <int kPixels, int kVecs, Lanes kLanes>
void tile(const Job& j) {
  static_assert(kPixels * kVecs <= kMaxSums);
  Vec sum[kPixels][kVecs];
  for (int v = 0; v < kVecs; ++v) {
    const Vec begin = load(j.begin + v * kHalves);
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      sum[p][v] = begin;
    }
  }
  std::ptrdiff_t k = 0;
  const Half* panel = j.x;
  std::int32_t left = j.in_blocks;
  do {
    const Half* end = panel + std::min(left, 4) * 8;
    const Half* x = panel;
#pragma GCC unroll 1
    do {
      Vec weight[kVecs];
      for (int v = 0; v < kVecs; ++v) {
        weight[v] = weights_at<kLanes>(j, v, k);
      }
#pragma GCC unroll 16
      for (int p = 0; p < kPixels; ++p) {
        const Vec value = broadcast<kLanes>(x + p * kHalves);
        for (int v = 0; v < kVecs; ++v) {
          sum[p][v] = _mm512_fmadd_ph(value, weight[v], sum[p][v]);
        }
      }
      x += kAtOnce<kLanes>;
      k += kAtOnce<kLanes>;
    } while (x < end);
    panel += j.x_panel;
    left -= 4;
  } while (left > 0);
  Half* y = j.y;
  std::int32_t column = j.column;
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p, y += kHalves) {
    for (int v = 0; v < kVecs; ++v) {
      _mm512_storeu_ph(y + v * j.y_vec, _mm512_min_ph(j.high, _mm512_max_ph(j.low, sum[p][v])));
    }
    if (++column == j.row_pixels) {
      column = 0;
      y += j.gap;
    }
  }
}

using Tile = SizedTile<void (*)(const Job&)>;
using Tiles = Tiling<void (*)(const Job&)>;

template <int kVecs, Lanes kLanes, int... kSizes>
Tiles one_of(std::int32_t pixels) {
  static constexpr Tile kTiles[] = {{kSizes, &tile<kSizes, kVecs, kLanes>}...};
  return tiling_of(kTiles, pixels);
}

Tiles tiles_of(Lanes lanes, std::int32_t vecs, std::int32_t pixels) {
  switch (lanes) {
    case Lanes::kSome:
      return one_of<1, Lanes::kSome, 1, 4, 9, 13>(pixels);
    case Lanes::kPairs:
      return one_of<1, Lanes::kPairs, 1, 4, 9, 13>(pixels);
    case Lanes::kQuads:
      return one_of<1, Lanes::kQuads, 1, 4, 9, 13>(pixels);
    case Lanes::k32:
      break;
  }
  switch (vecs) {
    case 1:
      return one_of<1, Lanes::k32, 1, 4, 9, 13>(pixels);
    case 2:
      return one_of<2, Lanes::k32, 1, 4, 8, 9, 10, 13, 14>(pixels);
    case 3:
      return one_of<3, Lanes::k32, 9>(pixels);
    default:
      return one_of<4, Lanes::k32, 1, 2, 4, 6>(pixels);
  }
}

// Calls run(tile, its first pixel) for each tile.
template <class Run>
void for_each_tile(const Tiles& tiles, std::int32_t pixels, Run run) {
  for (std::int32_t i = 0; i < tiles.count; ++i) {
    run(tiles.each, i * tiles.each.pixels);
  }
  if (tiles.last.run != nullptr) {
    run(tiles.last, pixels - tiles.last.pixels);
  }
}

// Number of output vectors to compute together when `left` remain. Tiles of three vectors exist
// only with nine pixels.
std::int32_t vecs_together(std::int32_t pixels, std::int32_t left) {
  const std::int32_t at_once = pixels <= 6 ? 4 : pixels == 9 ? 3 : 2;
  const std::int32_t vecs = std::min(at_once, left);
  return vecs == 3 && pixels != 9 ? 2 : vecs;
}

// Outputs computed together.
struct Group {
  std::int32_t block, blocks;
  Lanes lanes;
  [[nodiscard]] std::int32_t vecs() const { return (blocks + 3) / 4; }
};

Job job_of(const HalfProduct& a, const Group& g) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.in_blocks} * 8;
  Job job{};
  job.x_panel = a.x_panel_elems;
  job.in_blocks = a.in_blocks;
  job.w = a.weights + g.block * 8 * reduction;
  job.panel = reduction * kPanel;
  job.out_blocks = g.blocks;
  return job;
}

// Iterates over whole vectors, then the rest.
template <class Run>
void for_each_group(const HalfProduct& a, bool splits, Run run) {
  std::int32_t block = 0;
  while (a.out_blocks - block >= 4) {
    const std::int32_t vecs = vecs_together(a.pixels, (a.out_blocks - block) / 4);
    run(Group{block, 4 * vecs, Lanes::k32});
    block += 4 * vecs;
  }
  const std::int32_t left = a.out_blocks - block;
  if (!splits && left > 0) {
    run(Group{block, left, Lanes::kSome});
  } else {
    if (left > 1) {
      run(Group{block, 2, Lanes::kPairs});
    }
    if (left % 2 != 0) {
      run(Group{block + left - 1, 1, Lanes::kQuads});
    }
  }
}

// Loads the biases of a group into the first lanes of its outputs; the other lanes are 0.
void load_bias(const HalfProduct& a, const Group& g, Half* to) {
  const std::int32_t step = g.lanes == Lanes::kPairs ? 2 : g.lanes == Lanes::kQuads ? 4 : 1;
  std::fill(to, to + g.vecs() * kHalves, Half{0});
  for (std::int32_t i = 0; i < g.blocks * 8; ++i) {
    to[i * step] = a.bias[g.block * 8 + i];
  }
}

void expand_group(const HalfProduct& a, const StripRows& to, const Group& g) {
  Half bias[kMaxVecs * kHalves];
  load_bias(a, g, bias);
  Job job = job_of(a, g);
  job.begin = bias;
  job.low = set(a.low);
  job.high = set(a.high);
  job.y_vec = to.panel_elems;
  job.row_pixels = to.row_pixels;
  job.gap = to.row_elems - std::ptrdiff_t{to.row_pixels} * kHalves;
  for_each_tile(tiles_of(g.lanes, g.vecs(), a.pixels), a.pixels,
                [&](const Tile& tile, std::int32_t pixel) {
                  const std::int32_t row = pixel / to.row_pixels;
                  job.column = pixel - row * to.row_pixels;
                  job.x = a.x + std::ptrdiff_t{pixel} * kHalves;
                  job.y = to.y + g.block / 4 * to.panel_elems + row * to.row_elems +
                          std::ptrdiff_t{job.column} * kHalves;
                  tile.run(job);
                });
}

// A vector of sums in fp32.
struct Sums {
  __m512 low, high;
};

Sums widened(const Half* at) {
  return {_mm512_cvtxph_ps(_mm256_loadu_ph(at)), _mm512_cvtxph_ps(_mm256_loadu_ph(at + 16))};
}

// Sums of adjacent lanes: those of `low`, then those of `high`.
__m512 sums_of_pairs(const Sums& s) {
  const __m512i even = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
  const __m512i odd = _mm512_set_epi32(31, 29, 27, 25, 23, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1);
  return _mm512_add_ps(_mm512_permutex2var_ps(s.low, even, s.high),
                       _mm512_permutex2var_ps(s.low, odd, s.high));
}

// fp32 sums of a tile, and fp16 sums of the last products, by vectors of outputs.
struct Totals {
  float* sums;    // `[vecs][pixels][32]`
  Half* partial;  // likewise
};

// Adds the fp16 sums to one vector of sums, or returns them alone if `is_first`.
Sums total_of(const Totals& t, std::ptrdiff_t at, bool is_first) {
  Sums sums = widened(t.partial + at);
  if (!is_first) {
    sums.low = _mm512_add_ps(sums.low, _mm512_loadu_ps(t.sums + at));
    sums.high = _mm512_add_ps(sums.high, _mm512_loadu_ps(t.sums + at + 16));
  }
  return sums;
}

void keep(const Totals& t, std::ptrdiff_t elems, bool is_first) {
  for (std::ptrdiff_t at = 0; at < elems; at += kHalves) {
    const Sums sums = total_of(t, at, is_first);
    _mm512_storeu_ps(t.sums + at, sums.low);
    _mm512_storeu_ps(t.sums + at + 16, sums.high);
  }
}

// The output pixels of a tile, for outputs from `block` on.
struct Place {
  const MapRows& to;
  std::int32_t pixel, pixels, block;
  float low, high;
};

template <Lanes kLanes>
void finish(const Totals& t, std::ptrdiff_t at, bool is_first, const Place& place) {
  const MapRows& to = place.to;
  const __m512 low = _mm512_set1_ps(place.low), high = _mm512_set1_ps(place.high);
  const std::ptrdiff_t plane = to.plane_elems, residual_plane = to.residual_plane_elems;
  const std::int32_t row = place.pixel / to.row_pixels;
  std::int32_t column = place.pixel - row * to.row_pixels;
  float* y = to.y + place.block * plane + std::ptrdiff_t{place.pixel} * 8;
  const float* r = to.residual == nullptr
                       ? nullptr
                       : to.residual + place.block * residual_plane + row * to.residual_row_elems +
                             std::ptrdiff_t{column} * 8;
  const auto store = [&](__m512 sum, std::int32_t block, bool both) {
    __m512 value = _mm512_min_ps(high, _mm512_max_ps(low, sum));
    if (r != nullptr) {
      const __m512 more = avx512::load_blocks(r + block * residual_plane, residual_plane, both);
      value = _mm512_add_ps(value, more);
    }
    avx512::store_blocks(y + block * plane, plane, both, value);
  };
  for (std::int32_t p = 0; p < place.pixels; ++p, at += kHalves, y += 8) {
    const Sums sums = total_of(t, at, is_first);
    if constexpr (kLanes == Lanes::kPairs) {
      store(sums_of_pairs(sums), 0, true);
    } else if constexpr (kLanes == Lanes::kQuads) {
      const __m512 pairs = sums_of_pairs(sums);
      store(sums_of_pairs({pairs, pairs}), 0, false);
    } else {
      store(sums.low, 0, true);
      store(sums.high, 2, true);
    }
    if (r != nullptr) {
      r += 8;
      if (++column == to.row_pixels) {
        column = 0;
        r += to.residual_row_elems - std::ptrdiff_t{to.row_pixels} * 8;
      }
    }
  }
}

void finish(Lanes lanes, const Totals& t, std::ptrdiff_t at, bool is_first, const Place& place) {
  switch (lanes) {
    case Lanes::kPairs:
      return finish<Lanes::kPairs>(t, at, is_first, place);
    case Lanes::kQuads:
      return finish<Lanes::kQuads>(t, at, is_first, place);
    default:
      return finish<Lanes::k32>(t, at, is_first, place);
  }
}

void project_tile(const HalfProduct& a, const MapRows& to, const Group& g, const Tile& tile,
                  std::int32_t pixel, Job job, const Totals& totals) {
  alignas(64) static constexpr Half kZeros[kMaxVecs * kHalves] = {};
  constexpr std::int32_t kBlocks = kHalfSum / 8;
  const std::ptrdiff_t step = (g.lanes == Lanes::kQuads ? 8 : kPanel) * kHalfSum;
  const std::ptrdiff_t vec = std::ptrdiff_t{tile.pixels} * kHalves;
  job.x = a.x + std::ptrdiff_t{pixel} * kHalves;
  job.y = totals.partial;
  job.y_vec = vec;
  std::int32_t block = 0;
  for (; a.in_blocks - block > kBlocks; block += kBlocks) {
    job.in_blocks = kBlocks;
    tile.run(job);
    keep(totals, g.vecs() * vec, block == 0);
    job.x += kHalfSum / kHalves * a.x_panel_elems;
    job.w += step;
    job.begin = kZeros;
  }
  job.in_blocks = a.in_blocks - block;
  tile.run(job);
  for (std::int32_t v = 0; v < g.vecs(); ++v) {
    finish(g.lanes, totals, v * vec, block == 0,
           {to, pixel, tile.pixels, g.block + 4 * v, a.low, a.high});
  }
}

void project_group(const HalfProduct& a, const MapRows& to, const Group& g, const Totals& totals) {
  Half bias[kMaxVecs * kHalves];
  load_bias(a, g, bias);
  Job job = job_of(a, g);
  job.begin = bias;
  job.low = set(-__builtin_inff());
  job.high = set(__builtin_inff());
  for_each_tile(tiles_of(g.lanes, g.vecs(), a.pixels), a.pixels,
                [&](const Tile& tile, std::int32_t pixel) {
                  project_tile(a, to, g, tile, pixel, job, totals);
                });
}

}  // namespace

void multiply_to_strip(const HalfProduct& a, const StripRows& to) {
  for_each_group(a, false, [&](const Group& g) { expand_group(a, to, g); });
}

void multiply_to_map(const HalfProduct& a, const MapRows& to, float* scratch) {
  const Totals totals{scratch, reinterpret_cast<Half*>(scratch + kMaxSums * kHalves)};
  for_each_group(a, true, [&](const Group& g) { project_group(a, to, g, totals); });
}

}  // namespace mien::kernels::avx512fp16
