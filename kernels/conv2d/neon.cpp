// Register tiles as in the pointwise kernel where whole windows lie inside the map, single pixels
// at its border. A window is a series of runs: inputs that are contiguous in x and whose weights
// are contiguous. In interleaved maps a run is a whole row of the window.
#include <algorithm>

#include "kernels/common/neon_activation.h"
#include "kernels/common/neon_weights.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct Range {
  std::int32_t first, last;  // [first, last)
};

Range inside(std::int32_t origin, std::int32_t kernel, std::int32_t size) {
  return {std::max(0, -origin), std::min(kernel, size - origin)};
}

// Output columns whose whole window lies inside the map.
Range whole_windows(const Conv2dArgs& a) {
  const std::int32_t first = std::min(a.out_w, (a.pad_left + a.stride_w - 1) / a.stride_w);
  const std::int32_t last_start = a.in_w + a.pad_left - a.kernel_w;
  return {first, last_start < 0 ? first : std::clamp(last_start / a.stride_w + 1, first, a.out_w)};
}

template <class Source>
struct Outputs {
  const Conv2dArgs& a;
  const Activator& activator;
  Source weights;
  std::int32_t channel;  // first channel
};

// Adds `count` inputs from x on, for pixels `step` floats apart.
template <int kPixels, int kVecs, class T>
[[gnu::always_inline]] inline void add_run(const float* x, std::ptrdiff_t step, std::int32_t count,
                                           const T* w, std::ptrdiff_t row_elems,
                                           Vec (&sums)[1][kPixels][kVecs]) {
  for (; count >= kLanes; count -= kLanes, x += kLanes, w += kLanes * row_elems) {
    add_four_inputs(x, step, w, row_elems, sums);
  }
  for (; count > 0; --count, ++x, w += row_elems) {
    Vec inputs[kPixels];
    MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) { inputs[p] = vld1q_dup_f32(x + p * step); }
    Vec row[kVecs];
    load_row(w, row);
    MIEN_UNROLLED for (int i = 0; i < kPixels * kVecs; ++i) {
      const int p = i % kPixels, v = i / kPixels;
      sums[0][p][v] = fma_lane<0>(sums[0][p][v], row[v], inputs[p]);
    }
  }
}

template <int kPixels, int kVecs>
[[gnu::always_inline]] inline void store(const Conv2dArgs& a, std::int32_t channel, std::int32_t oy,
                                         std::int32_t ox, const Vec (&sums)[kPixels][kVecs]) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.out_h} * a.out_w * kBlock;
  float* y = a.y + channel / kBlock * plane + (std::ptrdiff_t{oy} * a.out_w + ox) * kBlock;
  MIEN_UNROLLED for (int v = 0; v < kVecs; v += 2) {
    MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
      store_pair(y + v / 2 * plane + p * kBlock, {sums[p][v], sums[p][v + 1]});
    }
  }
}

// Output pixels ox .. ox + kPixels - 1 of row oy, over kernel rows `ys` and columns `xs`.
template <int kPixels, int kVecs, class Source>
[[gnu::noinline]] void tile(const Outputs<Source>& out, std::int32_t oy, std::int32_t ox,
                            const Range& ys, const Range& xs) {
  const Conv2dArgs& a = out.a;
  const std::ptrdiff_t row_elems = out.weights.template row_elems<kVecs>();
  const std::ptrdiff_t step = std::ptrdiff_t{a.stride_w} * a.x_pixel_elems;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const bool interleaved = a.x_pixel_elems == a.in_c;
  const std::int32_t runs = interleaved ? 1 : xs.last - xs.first;
  const std::int32_t run_pixels = interleaved ? xs.last - xs.first : 1;
  const std::int32_t top = oy * a.stride_h - a.pad_top, left = ox * a.stride_w - a.pad_left;
  Vec sums[1][kPixels][kVecs];
  start_sums(a.bias + out.channel, sums);
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    const float* x = a.x + (std::ptrdiff_t{top + ky} * a.in_w + left + xs.first) * a.x_pixel_elems;
    const std::ptrdiff_t k = (std::ptrdiff_t{ky} * a.kernel_w + xs.first) * a.in_c;
    const auto* w = out.weights.first + k * row_elems;
    for (std::int32_t run = 0; run < runs; ++run, x += a.x_pixel_elems) {
      const float* block = x;
      std::int32_t left_over = run_pixels * a.in_c;
      while (left_over > 0) {
        const std::int32_t count = interleaved ? left_over : std::min(kBlock, left_over);
        add_run(block, step, count, w, row_elems, sums);
        w += count * row_elems;
        block += plane;
        left_over -= count;
      }
    }
  }
  out.activator.apply(sums[0], out.channel);
  store(a, out.channel, oy, ox, sums[0]);
}

template <int kVecs, class Source>
void row(const Outputs<Source>& out, std::int32_t oy) {
  constexpr int kMax = kTilePixels<kVecs>;
  constexpr int kSmaller = (kMax + 1) / 2;
  const Conv2dArgs& a = out.a;
  const Range ys = inside(oy * a.stride_h - a.pad_top, a.kernel_h, a.in_h);
  const Range whole = whole_windows(a);
  const Range all{0, a.kernel_w};
  std::int32_t ox = 0;
  const auto single_pixels = [&](std::int32_t end) {
    for (; ox < end; ++ox) {
      const Range xs = inside(ox * a.stride_w - a.pad_left, a.kernel_w, a.in_w);
      tile<1, kVecs>(out, oy, ox, ys, xs);
    }
  };
  single_pixels(whole.first);
  for (; ox + kMax <= whole.last; ox += kMax) {
    tile<kMax, kVecs>(out, oy, ox, ys, all);
  }
  for (; ox + kSmaller <= whole.last; ox += kSmaller) {
    tile<kSmaller, kVecs>(out, oy, ox, ys, all);
  }
  single_pixels(a.out_w);
}

template <int kVecs, class Source>
void all_rows(const Outputs<Source>& out) {
  for (std::int32_t oy = 0; oy < out.a.out_h; ++oy) {
    row<kVecs>(out, oy);
  }
}

template <int kVecs>
void widened_outputs(const Outputs<Halves>& out, std::ptrdiff_t rows) {
  float space[kWidenedElems];
  const Widened widened = widen<kVecs>(out.weights, rows, space);
  all_rows<kVecs>(Outputs<Widened>{out.a, out.activator, widened, out.channel});
}

}  // namespace

void conv2d(const Conv2dArgs& a) {
  const Activator activator(a.activation, a.out_c);
  const std::ptrdiff_t rows = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c;
  const std::int32_t padded = blocks_of(a.out_c) * kBlock;
  for (std::int32_t channel = 0; channel < padded; channel += kPanel) {
    const std::int32_t width = padded - channel < kPanel ? kBlock : kPanel;
    const std::uint16_t* panel = a.weights + channel * rows;
    if (width == kPanel && rows * kPanel <= kWidenedElems) {
      widened_outputs<4>({a, activator, {panel, width}, channel}, rows);
      continue;
    }
    for (std::int32_t i = 0; i < width; i += kBlock) {
      const Outputs<Halves> out{a, activator, {panel + i, width}, channel + i};
      if (rows * kBlock <= kWidenedElems) {
        widened_outputs<2>(out, rows);
      } else {
        all_rows<2>(out);
      }
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
