// Register tiles as in the pointwise kernel where whole windows lie inside the map, single pixels
// at its border. A window is a series of runs: inputs that are contiguous in x and whose weights
// are contiguous. In interleaved maps a run is a whole row of the window.
#include <algorithm>

#include "kernels/common/wasm_activation.h"
#include "kernels/common/wasm_weights.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

constexpr int kVecs = 2;  // one block
constexpr int kMaxPixels = 5;
constexpr int kSomePixels = 3;

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

template <int kPixels>
inline void store_sums(const Conv2dArgs& a, const Activator& activator, std::int32_t channel,
                       std::int32_t oy, std::int32_t ox, const Vec (&sums)[kPixels][kVecs]) {
  const std::ptrdiff_t plane = std::ptrdiff_t{a.out_h} * a.out_w * kBlock;
  float* y = a.y + channel / kBlock * plane + (std::ptrdiff_t{oy} * a.out_w + ox) * kBlock;
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      store(y + p * kBlock + v * kLanes, activator.clamped(sums[p][v]));
    }
  }
}

// The runs of one row of the window: `pixels` pixels long, or one pixel each.
struct Runs {
  std::int32_t count, elems;

  Runs(const Conv2dArgs& a, std::int32_t pixels) {
    const bool interleaved = a.x_pixel_elems == a.in_c;
    count = interleaved ? 1 : pixels;
    elems = interleaved ? pixels * a.in_c : a.in_c;
    longest = interleaved ? elems : kBlock;
  }
  std::int32_t longest;  // maximum; x then continues in the next block
};

// Output pixels ox .. ox + kPixels - 1 of row oy, over kernel rows `ys` and columns `xs`.
template <int kPixels, class Source>
[[gnu::noinline]] void tile(const Outputs<Source>& out, std::int32_t oy, std::int32_t ox,
                            const Range& ys, const Range& xs) {
  const Conv2dArgs& a = out.a;
  const std::ptrdiff_t row_elems = out.weights.template row_elems<kVecs>();
  const std::ptrdiff_t step = std::ptrdiff_t{a.stride_w} * a.x_pixel_elems;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const Runs runs(a, xs.last - xs.first);
  const std::int32_t top = oy * a.stride_h - a.pad_top, left = ox * a.stride_w - a.pad_left;
  Vec sums[kPixels][kVecs];
  start_sums(a.bias + out.channel, sums);
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    const float* x = a.x + (std::ptrdiff_t{top + ky} * a.in_w + left + xs.first) * a.x_pixel_elems;
    const std::ptrdiff_t k = (std::ptrdiff_t{ky} * a.kernel_w + xs.first) * a.in_c;
    const auto* w = out.weights.first + k * row_elems;
    for (std::int32_t run = 0; run < runs.count; ++run, x += a.x_pixel_elems) {
      const float* block = x;
      for (std::int32_t begin = 0; begin < runs.elems; begin += runs.longest, block += plane) {
        const std::int32_t count = std::min(runs.longest, runs.elems - begin);
        for (std::int32_t i = 0; i < count; ++i, w += row_elems) {
          add_input(block + i, step, w, sums);
        }
      }
    }
  }
  store_sums(a, out.activator, out.channel, oy, ox, sums);
}

template <class Source>
void row(const Outputs<Source>& out, std::int32_t oy) {
  const Conv2dArgs& a = out.a;
  const Range ys = inside(oy * a.stride_h - a.pad_top, a.kernel_h, a.in_h);
  const Range whole = whole_windows(a);
  const Range all{0, a.kernel_w};
  std::int32_t ox = 0;
  const auto single_pixels = [&](std::int32_t end) {
    for (; ox < end; ++ox) {
      const Range xs = inside(ox * a.stride_w - a.pad_left, a.kernel_w, a.in_w);
      tile<1>(out, oy, ox, ys, xs);
    }
  };
  single_pixels(whole.first);
  for (; ox + kMaxPixels <= whole.last; ox += kMaxPixels) {
    tile<kMaxPixels>(out, oy, ox, ys, all);
  }
  for (; ox + kSomePixels <= whole.last; ox += kSomePixels) {
    tile<kSomePixels>(out, oy, ox, ys, all);
  }
  single_pixels(a.out_w);
}

template <class Source>
void all_rows(const Outputs<Source>& out) {
  for (std::int32_t oy = 0; oy < out.a.out_h; ++oy) {
    row(out, oy);
  }
}

void widened_outputs(const Outputs<Halves>& out, std::ptrdiff_t rows) {
  float space[kWidenedElems];
  all_rows(
      Outputs<Widened>{out.a, out.activator, widen<kVecs>(out.weights, rows, space), out.channel});
}

}  // namespace

void conv2d(const Conv2dArgs& a) {
  const Activator activator(a.activation, a.out_c);
  const std::ptrdiff_t rows = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c;
  const std::int32_t padded = blocks_of(a.out_c) * kBlock;
  for (std::int32_t channel = 0; channel < padded; channel += kBlock) {
    const std::int32_t panel = channel / kPanel * kPanel;
    const std::int32_t width = padded - panel < kPanel ? kBlock : kPanel;
    const Halves weights{a.weights + panel * rows + (channel - panel), width};
    const Outputs<Halves> out{a, activator, weights, channel};
    if (fits_widened<kVecs>(rows)) {
      widened_outputs(out, rows);
    } else {
      all_rows(out);
    }
    const std::ptrdiff_t pixels = std::ptrdiff_t{a.out_h} * a.out_w;
    for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
      activator.curve_channels(a.y + channel * pixels + lane, pixels, channel + lane);
    }
  }
}

}  // namespace mien::kernels::wasm
