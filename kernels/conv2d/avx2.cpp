// Tiles of up to 6 output pixels of a row x 16 output channels where the whole windows lie inside
// the map; pixels at the border one at a time.
#include <algorithm>

#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

constexpr int kTilePixels = 6;

struct Range {
  std::int32_t first, last;
};

Range inside(std::int32_t origin, std::int32_t kernel, std::int32_t size) {
  return {std::max(0, -origin), std::min(kernel, size - origin)};
}

// Output columns [first, last) whose whole window lies inside the map.
Range whole_windows(const Conv2dArgs& a) {
  const std::int32_t first = std::min(a.out_w, (a.pad_left + a.stride_w - 1) / a.stride_w);
  const std::int32_t room = a.in_w + a.pad_left - a.kernel_w;
  return {first, room < 0 ? first : std::clamp(room / a.stride_w + 1, first, a.out_w)};
}

struct Panel {
  const Conv2dArgs& a;
  const std::uint16_t* weights;
  std::int32_t block;
};

template <int kPixels, int kVecs>
void add_channels(const Conv2dArgs& a, const float* x, const std::uint16_t* w,
                  Vec (&sum)[kPixels][kVecs]) {
  const std::ptrdiff_t step = std::ptrdiff_t{a.stride_w} * a.x_pixel_elems;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kLanes;
  for (std::int32_t c = 0; c < a.in_c; c += kLanes, x += plane) {
    const std::int32_t lanes = std::min(kLanes, a.in_c - c);
    for (std::int32_t lane = 0; lane < lanes; ++lane, w += kVecs * kLanes) {
      Vec weight[kVecs];
      for (int v = 0; v < kVecs; ++v) {
        weight[v] = load_half(w + v * kLanes);
      }
      for (int p = 0; p < kPixels; ++p) {
        const Vec value = _mm256_broadcast_ss(x + p * step + lane);
        for (int v = 0; v < kVecs; ++v) {
          sum[p][v] = _mm256_fmadd_ps(value, weight[v], sum[p][v]);
        }
      }
    }
  }
}

// Output pixels ox .. ox + kPixels - 1 of row oy, over kernel rows `ys` and columns `xs`.
template <int kPixels, int kVecs>
void tile(const Panel& panel, std::int32_t oy, std::int32_t ox, Range ys, Range xs) {
  const Conv2dArgs& a = panel.a;
  Vec sum[kPixels][kVecs];
  for (auto& pixel : sum) {
    for (Vec& one : pixel) {
      one = _mm256_setzero_ps();
    }
  }
  const std::int32_t top = oy * a.stride_h - a.pad_top, left = ox * a.stride_w - a.pad_left;
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    for (std::int32_t kx = xs.first; kx < xs.last; ++kx) {
      const float* x = a.x + (std::ptrdiff_t{top + ky} * a.in_w + left + kx) * a.x_pixel_elems;
      const std::ptrdiff_t k = std::ptrdiff_t{ky * a.kernel_w + kx} * a.in_c;
      add_channels<kPixels, kVecs>(a, x, panel.weights + k * kVecs * kLanes, sum);
    }
  }
  const std::ptrdiff_t plane = std::ptrdiff_t{a.out_h} * a.out_w;
  for (int v = 0; v < kVecs; ++v) {
    const std::int32_t block = panel.block + v;
    const Vec bias = load_half(a.bias + block * kLanes);
    float* y = a.y + (block * plane + std::ptrdiff_t{oy} * a.out_w + ox) * kLanes;
    for (int p = 0; p < kPixels; ++p) {
      _mm256_storeu_ps(y + p * kLanes,
                       activated(_mm256_add_ps(sum[p][v], bias), a.activation, block, a.out_c));
    }
  }
}

template <int kVecs>
void row(const Panel& panel, std::int32_t oy) {
  const Conv2dArgs& a = panel.a;
  const Range ys = inside(oy * a.stride_h - a.pad_top, a.kernel_h, a.in_h);
  const Range whole = whole_windows(a);
  const Range all{0, a.kernel_w};
  std::int32_t ox = 0;
  const auto edge = [&](std::int32_t end) {
    for (; ox < end; ++ox) {
      tile<1, kVecs>(panel, oy, ox, ys, inside(ox * a.stride_w - a.pad_left, a.kernel_w, a.in_w));
    }
  };
  edge(whole.first);
  for (; ox + kTilePixels <= whole.last; ox += kTilePixels) {
    tile<kTilePixels, kVecs>(panel, oy, ox, ys, all);
  }
  for (; ox + 2 <= whole.last; ox += 2) {
    tile<2, kVecs>(panel, oy, ox, ys, all);
  }
  edge(a.out_w);
}

template <int kVecs>
void all_rows(const Panel& panel) {
  for (std::int32_t oy = 0; oy < panel.a.out_h; ++oy) {
    row<kVecs>(panel, oy);
  }
}

}  // namespace

void conv2d(const Conv2dArgs& a) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.kernel_h} * a.kernel_w * a.in_c;
  const std::int32_t blocks = blocks_of(a.out_c);
  const std::uint16_t* w = a.weights;
  std::int32_t block = 0;
  for (; block + 2 <= blocks; block += 2, w += reduction * kPanel) {
    all_rows<2>({a, w, block});
  }
  if (block < blocks) {
    all_rows<1>({a, w, block});
  }
}

}  // namespace mien::kernels::avx2
