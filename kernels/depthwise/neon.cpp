// 3x3 windows inside the map use the tiles of neon_window.h. Small maps are copied with their
// padding to the stack, so that all windows lie inside the copy; other windows that exceed the map
// are computed one output at a time.
#include <algorithm>

#include "kernels/common/neon_activation.h"
#include "kernels/depthwise/neon_window.h"
#include "kernels/depthwise/padded.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
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

// Parameters common to all outputs of Floats::kVecs vectors of channels.
struct Channels {
  const DepthwiseArgs& a;
  const float* x;
  float* y;
  Taps<Floats> taps;

  Channels(const DepthwiseArgs& args, const Activator& activator, std::int32_t channel,
           const float* map)
      : a(args),
        x(map + channel % kBlock),
        y(args.y + std::ptrdiff_t{channel / kBlock} * args.out_h * args.out_w * kBlock +
          channel % kBlock),
        taps(args.weights +
                 std::ptrdiff_t{channel / kBlock} * args.kernel_h * args.kernel_w * kBlock +
                 channel % kBlock,
             kLanes, args.bias + channel, kLanes, {activator.low(), activator.high()}) {}

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
  float* y = ch.output(oy, ox);
  Vec sums[Floats::kVecs];
  MIEN_UNROLLED for (int v = 0; v < Floats::kVecs; ++v) {
    sums[v] = vld1q_f32(ch.taps.biases + v * kLanes);
  }
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    const float* row = origin + std::ptrdiff_t{ky} * a.in_w * kBlock;
    for (std::int32_t kx = xs.first; kx < xs.last; ++kx) {
      const std::uint16_t* w = ch.taps.weights + (ky * a.kernel_w + kx) * kBlock;
      MIEN_UNROLLED for (int v = 0; v < Floats::kVecs; ++v) {
        const Vec x = vld1q_f32(row + kx * kBlock + v * kLanes);
        sums[v] = fma(sums[v], x, load_half(w + v * kLanes));
      }
    }
  }
  ch.taps.finish.store(y, sums);
}

void edge_outputs(const Channels& ch, std::int32_t oy, std::int32_t first, std::int32_t last) {
  for (std::int32_t ox = first; ox < last; ++ox) {
    edge_output(ch, oy, ox);
  }
}

template <int kStride>
void channels_3x3(const Channels& ch) {
  const DepthwiseArgs& a = ch.a;
  const Range rows = whole_windows(a.out_h, kStride, a.pad_top, 3, a.in_h);
  const Range columns = whole_windows(a.out_w, kStride, a.pad_left, 3, a.in_w);
  for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
    const bool whole = oy >= rows.first && oy < rows.last;
    edge_outputs(ch, oy, 0, whole ? columns.first : a.out_w);
    edge_outputs(ch, oy, whole ? columns.last : a.out_w, a.out_w);
  }
  const Rows<Floats> first{ch.input(rows.first, columns.first), std::ptrdiff_t{a.in_w} * kBlock,
                           ch.output(rows.first, columns.first), std::ptrdiff_t{a.out_w} * kBlock};
  all_whole_outputs<Floats, kStride, kBlock, kBlock>(ch.taps, first, rows.last - rows.first,
                                                     columns.last - columns.first);
}

void channels_any(const Channels& ch) {
  for (std::int32_t oy = 0; oy < ch.a.out_h; ++oy) {
    edge_outputs(ch, oy, 0, ch.a.out_w);
  }
}

[[gnu::noinline]] void all_channels(const DepthwiseArgs& a, const Activator& activator,
                                    std::int32_t block, const float* map) {
  const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3 && a.stride_h == a.stride_w;
  for (std::int32_t v = 0; v < kBlock / kLanes; v += Floats::kVecs) {
    const Channels channels(a, activator, block * kBlock + v * kLanes, map);
    if (is_3x3 && a.stride_h == 1) {
      channels_3x3<1>(channels);
    } else if (is_3x3 && a.stride_h == 2) {
      channels_3x3<2>(channels);
    } else {
      channels_any(channels);
    }
  }
  if (activator.curves()) {
    const std::ptrdiff_t pixels = std::ptrdiff_t{a.out_h} * a.out_w;
    activator.curve_block(a.y + block * pixels * kBlock, pixels, block);
  }
}

using InStack = Padded<96>;

}  // namespace

void depthwise(const DepthwiseArgs& a) {
  const Activator activator(a.activation, a.channels);
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const std::int32_t blocks = blocks_of(a.channels);
  if (InStack::accepts(a)) {
    InStack padded(a);
    for (std::int32_t block = 0; block < blocks; ++block) {
      all_channels(padded.args(), activator, block, padded.filled(a.x + block * plane));
    }
    return;
  }
  for (std::int32_t block = 0; block < blocks; ++block) {
    all_channels(a, activator, block, a.x + block * plane);
  }
}

}  // namespace mien::kernels::MIEN_TIER
