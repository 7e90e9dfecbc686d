// Four channels at a time. 3x3 windows inside the map are computed four outputs of a row at once,
// others one at a time. Small maps are copied with their padding to the stack, so that all windows
// lie inside the copy.
#include <algorithm>

#include "kernels/common/wasm_activation.h"
#include "kernels/depthwise/padded.h"
#include "kernels/depthwise/wasm_window.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

struct Range {
  std::int32_t first, last;  // [first, last)
};

Range inside(std::int32_t origin, std::int32_t kernel, std::int32_t size) {
  return {std::max(0, -origin), std::min(kernel, size - origin)};
}

// Outputs of a row or column whose whole window lies inside the map.
Range whole_windows(std::int32_t outputs, std::int32_t stride, std::int32_t pad,
                    std::int32_t kernel, std::int32_t size) {
  const std::int32_t first = std::min(outputs, (pad + stride - 1) / stride);
  const std::int32_t last_start = size + pad - kernel;
  const std::int32_t last =
      last_start < 0 ? first : std::clamp(last_start / stride + 1, first, outputs);
  return {first, last};
}

// Parameters common to all outputs of four channels.
struct Channels {
  const DepthwiseArgs& a;
  Vec low, high;
  const float* x;
  float* y;
  const std::uint16_t* weights;
  Vec bias;

  Channels(const DepthwiseArgs& args, const Activator& activator, std::int32_t channel,
           const float* map)
      : a(args),
        low(activator.low()),
        high(activator.high()),
        bias(load_half(args.bias + channel)) {
    const std::ptrdiff_t block = channel / kBlock, lane = channel % kBlock;
    x = map + lane;
    y = a.y + block * a.out_h * a.out_w * kBlock + lane;
    weights = a.weights + block * a.kernel_h * a.kernel_w * kBlock + lane;
  }
  // Address of output (oy, ox), and of the first input in its window.
  [[nodiscard]] float* output(std::int32_t oy, std::int32_t ox) const {
    return y + (std::ptrdiff_t{oy} * a.out_w + ox) * kBlock;
  }
  [[nodiscard]] const float* input(std::int32_t oy, std::int32_t ox) const {
    const std::int32_t top = oy * a.stride_h - a.pad_top, left = ox * a.stride_w - a.pad_left;
    return x + (std::ptrdiff_t{top} * a.in_w + left) * kBlock;
  }
};

void edge_output(const Channels& ch, std::int32_t oy, std::int32_t ox) {
  const DepthwiseArgs& a = ch.a;
  const Range ys = inside(oy * a.stride_h - a.pad_top, a.kernel_h, a.in_h);
  const Range xs = inside(ox * a.stride_w - a.pad_left, a.kernel_w, a.in_w);
  const float* origin = ch.input(oy, ox);
  Vec sum = ch.bias;
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    const float* row = origin + std::ptrdiff_t{ky} * a.in_w * kBlock;
    for (std::int32_t kx = xs.first; kx < xs.last; ++kx) {
      const Vec weight = load_half(ch.weights + (ky * a.kernel_w + kx) * kBlock);
      sum = add_product(sum, load(row + kx * kBlock), weight);
    }
  }
  store(ch.output(oy, ox), min(max(sum, ch.low), ch.high));
}

void edge_outputs(const Channels& ch, std::int32_t oy, std::int32_t first, std::int32_t last) {
  for (std::int32_t ox = first; ox < last; ++ox) {
    edge_output(ch, oy, ox);
  }
}

// Outputs from y on, whose windows begin at x.
template <int kColumns, int kStride>
inline void tile(const Channels& ch, const Vec (&w)[9], const float* x, float* y) {
  Vec sums[kColumns];
  for (Vec& one : sums) {
    one = ch.bias;
  }
  add_windows_3x3<kStride, kBlock>(x, std::ptrdiff_t{ch.a.in_w} * kBlock, w, sums);
  for (int output = 0; output < kColumns; ++output) {
    store(y + output * kBlock, min(max(sums[output], ch.low), ch.high));
  }
}

template <int kStride>
void whole_row(const Channels& ch, const Vec (&w)[9], std::int32_t oy, const Range& columns) {
  constexpr int kColumns = 4;
  const float* x = ch.input(oy, columns.first);
  float* y = ch.output(oy, columns.first);
  std::int32_t left = columns.last - columns.first;
  for (; left >= kColumns; left -= kColumns) {
    tile<kColumns, kStride>(ch, w, x, y);
    x += kColumns * kStride * kBlock;
    y += kColumns * kBlock;
  }
  for (; left > 0; --left) {
    tile<1, kStride>(ch, w, x, y);
    x += kStride * kBlock;
    y += kBlock;
  }
}

template <int kStride>
void channels_3x3(const Channels& ch) {
  const DepthwiseArgs& a = ch.a;
  Vec w[9];
  for (int k = 0; k < 9; ++k) {
    w[k] = load_half(ch.weights + k * kBlock);
  }
  const Range rows = whole_windows(a.out_h, kStride, a.pad_top, 3, a.in_h);
  const Range columns = whole_windows(a.out_w, kStride, a.pad_left, 3, a.in_w);
  for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
    const bool whole = oy >= rows.first && oy < rows.last;
    edge_outputs(ch, oy, 0, whole ? columns.first : a.out_w);
    if (whole) {
      whole_row<kStride>(ch, w, oy, columns);
      edge_outputs(ch, oy, columns.last, a.out_w);
    }
  }
}

void channels_any(const Channels& ch) {
  for (std::int32_t oy = 0; oy < ch.a.out_h; ++oy) {
    edge_outputs(ch, oy, 0, ch.a.out_w);
  }
}

void one_block(const DepthwiseArgs& a, const Activator& activator, std::int32_t block,
               const float* map) {
  const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3 && a.stride_h == a.stride_w;
  for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
    const std::int32_t channel = block * kBlock + lane;
    const Channels channels(a, activator, channel, map);
    if (is_3x3 && a.stride_h == 1) {
      channels_3x3<1>(channels);
    } else if (is_3x3 && a.stride_h == 2) {
      channels_3x3<2>(channels);
    } else {
      channels_any(channels);
    }
    activator.curve_channels(channels.y, std::ptrdiff_t{a.out_h} * a.out_w, channel);
  }
}

using InStack = Padded<64>;

}  // namespace

void depthwise(const DepthwiseArgs& a) {
  const Activator activator(a.activation, a.channels);
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const std::int32_t blocks = blocks_of(a.channels);
  if (InStack::accepts(a)) {
    InStack padded(a);
    for (std::int32_t block = 0; block < blocks; ++block) {
      one_block(padded.args(), activator, block, padded.filled(a.x + block * plane));
    }
    return;
  }
  for (std::int32_t block = 0; block < blocks; ++block) {
    one_block(a, activator, block, a.x + block * plane);
  }
}

}  // namespace mien::kernels::wasm
