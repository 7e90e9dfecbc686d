// One block of channels at a time, with 3x3 weights in registers; four output pixels at once where
// whole windows lie inside the map, one at a time elsewhere.
#include <algorithm>

#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

struct Rows {
  std::int32_t first, last;  // kernel rows (or columns) [first, last) that lie inside the map
};

Rows inside(std::int32_t origin, std::int32_t kernel, std::int32_t size) {
  return {std::max(0, -origin), std::min(kernel, size - origin)};
}

// Outputs [first, last) of a row or column whose whole window lies inside the map.
Rows whole_windows(std::int32_t outputs, std::int32_t stride, std::int32_t pad, std::int32_t kernel,
                   std::int32_t size) {
  const std::int32_t first = std::min(outputs, (pad + stride - 1) / stride);
  const std::int32_t last_start = size + pad - kernel;
  const std::int32_t last =
      last_start < 0 ? first : std::clamp(last_start / stride + 1, first, outputs);
  return {first, last};
}

// Parameters common to all pixels of a block of channels.
struct Block {
  const DepthwiseArgs& a;
  std::int32_t index;
  const float* x;
  float* y;
  const std::uint16_t* weights;
  Vec bias;

  void store(Vec sum, std::int32_t oy, std::int32_t ox) const {
    const Vec value = activated(_mm256_add_ps(sum, bias), a.activation, index, a.channels);
    _mm256_storeu_ps(y + (std::ptrdiff_t{oy} * a.out_w + ox) * kLanes, value);
  }
};

void edge_pixel(const Block& b, std::int32_t oy, std::int32_t ox) {
  const DepthwiseArgs& a = b.a;
  const std::int32_t top = oy * a.stride_h - a.pad_top, left = ox * a.stride_w - a.pad_left;
  const Rows ys = inside(top, a.kernel_h, a.in_h), xs = inside(left, a.kernel_w, a.in_w);
  Vec sum = _mm256_setzero_ps();
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    const float* row = b.x + (std::ptrdiff_t{top + ky} * a.in_w + left) * kLanes;
    for (std::int32_t kx = xs.first; kx < xs.last; ++kx) {
      const Vec w = load_half(b.weights + (ky * a.kernel_w + kx) * kLanes);
      sum = _mm256_fmadd_ps(_mm256_loadu_ps(row + kx * kLanes), w, sum);
    }
  }
  b.store(sum, oy, ox);
}

template <int kPixels>
void whole_pixels(const Block& b, const Vec (&w)[9], std::int32_t oy, std::int32_t ox) {
  const DepthwiseArgs& a = b.a;
  const std::ptrdiff_t step = std::ptrdiff_t{a.stride_w} * kLanes;
  const float* origin =
      b.x + (std::ptrdiff_t{oy * a.stride_h - a.pad_top} * a.in_w + ox * a.stride_w - a.pad_left) *
                kLanes;
  Vec sum[kPixels];
  for (Vec& one : sum) {
    one = _mm256_setzero_ps();
  }
  for (int ky = 0; ky < 3; ++ky) {
    const float* row = origin + std::ptrdiff_t{ky} * a.in_w * kLanes;
    for (int kx = 0; kx < 3; ++kx) {
      for (int p = 0; p < kPixels; ++p) {
        const Vec x = _mm256_loadu_ps(row + p * step + kx * kLanes);
        sum[p] = _mm256_fmadd_ps(x, w[3 * ky + kx], sum[p]);
      }
    }
  }
  for (int p = 0; p < kPixels; ++p) {
    b.store(sum[p], oy, ox + p);
  }
}

void block_3x3(const Block& b) {
  const DepthwiseArgs& a = b.a;
  Vec w[9];
  for (int k = 0; k < 9; ++k) {
    w[k] = load_half(b.weights + k * kLanes);
  }
  const Rows rows = whole_windows(a.out_h, a.stride_h, a.pad_top, 3, a.in_h);
  const Rows columns = whole_windows(a.out_w, a.stride_w, a.pad_left, 3, a.in_w);
  for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
    const bool whole = oy >= rows.first && oy < rows.last;
    std::int32_t ox = 0;
    for (; ox < (whole ? columns.first : a.out_w); ++ox) {
      edge_pixel(b, oy, ox);
    }
    for (; whole && ox + 4 <= columns.last; ox += 4) {
      whole_pixels<4>(b, w, oy, ox);
    }
    for (; whole && ox < columns.last; ++ox) {
      whole_pixels<1>(b, w, oy, ox);
    }
    for (; ox < a.out_w; ++ox) {
      edge_pixel(b, oy, ox);
    }
  }
}

void block_any(const Block& b) {
  for (std::int32_t oy = 0; oy < b.a.out_h; ++oy) {
    for (std::int32_t ox = 0; ox < b.a.out_w; ++ox) {
      edge_pixel(b, oy, ox);
    }
  }
}

}  // namespace

void depthwise(const DepthwiseArgs& a) {
  const std::ptrdiff_t in_plane = std::ptrdiff_t{a.in_h} * a.in_w * kLanes;
  const std::ptrdiff_t out_plane = std::ptrdiff_t{a.out_h} * a.out_w * kLanes;
  const std::ptrdiff_t kernel = std::ptrdiff_t{a.kernel_h} * a.kernel_w * kLanes;
  const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3;
  for (std::int32_t i = 0; i < blocks_of(a.channels); ++i) {
    const Block block{a,
                      i,
                      a.x + i * in_plane,
                      a.y + i * out_plane,
                      a.weights + i * kernel,
                      load_half(a.bias + i * kLanes)};
    is_3x3 ? block_3x3(block) : block_any(block);
  }
}

}  // namespace mien::kernels::avx2
