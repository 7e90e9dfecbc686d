// 3x3 windows that lie inside the map are computed 2x2 outputs at a time, the weights of the block
// in registers, every input loaded once. Small maps with padding are copied to the stack with it,
// so that all of their windows do; other windows that leave the map are summed one output at a
// time.
#include <algorithm>

#include "kernels/common/neon_activation.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Vectors of a block that are worked on together: their 9 weights fill half of the registers.
#ifdef __aarch64__
constexpr int kVecs = 2;
#else
constexpr int kVecs = 1;
#endif

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
  const std::int32_t room = size + pad - kernel;
  const std::int32_t last = room < 0 ? first : std::clamp(room / stride + 1, first, outputs);
  return {first, last};
}

constexpr int kMostOutputs = 4;  // of a tile

// What is the same for all outputs of kVecs vectors of channels.
struct Channels {
  const DepthwiseArgs& a;
  Vec low, high;
  const float* x;
  float* y;
  const std::uint16_t* weights;
  // Once for every sum of a tile: to load it costs no time, to copy it from register to register
  // would, as the units that multiply do that.
  float biases[kMostOutputs * kVecs * kLanes];

  Channels(const DepthwiseArgs& args, const Activator& activator, std::int32_t channel,
           const float* map)
      : a(args), low(activator.low()), high(activator.high()) {
    const std::ptrdiff_t block = channel / kBlock, lane = channel % kBlock;
    x = map + lane;
    y = a.y + block * a.out_h * a.out_w * kBlock + lane;
    weights = a.weights + block * a.kernel_h * a.kernel_w * kBlock + lane;
    for (int i = 0; i < kMostOutputs * kVecs; ++i) {
      vst1q_f32(biases + i * kLanes, load_half(a.bias + channel + i % kVecs * kLanes));
    }
  }
  // Of output (oy, ox), and of the first input in its window.
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
  Vec sums[kVecs];
  MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) { sums[v] = vld1q_f32(ch.biases + v * kLanes); }
  for (std::int32_t ky = ys.first; ky < ys.last; ++ky) {
    const float* row = origin + std::ptrdiff_t{ky} * a.in_w * kBlock;
    for (std::int32_t kx = xs.first; kx < xs.last; ++kx) {
      const std::uint16_t* w = ch.weights + (ky * a.kernel_w + kx) * kBlock;
      MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
        const Vec x = vld1q_f32(row + kx * kBlock + v * kLanes);
        sums[v] = fma(sums[v], x, load_half(w + v * kLanes));
      }
    }
  }
  MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
    vst1q_f32(y + v * kLanes, vminq_f32(vmaxq_f32(sums[v], ch.low), ch.high));
  }
}

// The parameters of 3x3 windows, in registers but for the bias.
struct Window {
  Vec w[9][kVecs];
  Vec low, high;
  const float* biases;

  [[gnu::always_inline]] explicit Window(const Channels& ch)
      : low(ch.low), high(ch.high), biases(ch.biases) {
    MIEN_UNROLLED for (int i = 0; i < 9 * kVecs; ++i) {
      w[i / kVecs][i % kVecs] = load_half(ch.weights + i / kVecs * kBlock + i % kVecs * kLanes);
    }
  }
};

// Each input goes to the sums of all outputs whose windows it lies in.
template <int kRows, int kColumns, int kStride>
[[gnu::always_inline]] inline void tile(const Window& window, const float* x, std::ptrdiff_t x_row,
                                        float* y, std::ptrdiff_t y_row) {
  Vec sums[kRows * kColumns][kVecs];
  MIEN_UNROLLED for (int i = 0; i < kRows * kColumns * kVecs; ++i) {
    sums[i / kVecs][i % kVecs] = vld1q_f32(window.biases + i * kLanes);
  }
  MIEN_UNROLLED for (int i = 0; i < (kRows - 1) * kStride + 3; ++i) {
    MIEN_UNROLLED for (int j = 0; j < (kColumns - 1) * kStride + 3; ++j) {
      Vec input[kVecs];
      MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
        input[v] = vld1q_f32(x + i * x_row + j * kBlock + v * kLanes);
      }
      MIEN_UNROLLED for (int output = 0; output < kRows * kColumns; ++output) {
        const int ky = i - output / kColumns * kStride, kx = j - output % kColumns * kStride;
        if (ky >= 0 && ky < 3 && kx >= 0 && kx < 3) {
          MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
            sums[output][v] = fma(sums[output][v], input[v], window.w[3 * ky + kx][v]);
          }
        }
      }
    }
  }
  MIEN_UNROLLED for (int i = 0; i < kRows * kColumns * kVecs; ++i) {
    const int output = i / kVecs, v = i % kVecs;
    vst1q_f32(y + output / kColumns * y_row + output % kColumns * kBlock + v * kLanes,
              vminq_f32(vmaxq_f32(sums[output][v], window.low), window.high));
  }
}

template <int kRows, int kStride>
[[gnu::noinline]] void whole_outputs(const Channels& ch, std::int32_t oy, const Range& columns) {
  const Window window(ch);
  const float* x = ch.input(oy, columns.first);
  float* y = ch.output(oy, columns.first);
  const std::ptrdiff_t x_row = std::ptrdiff_t{ch.a.in_w} * kBlock;
  const std::ptrdiff_t y_row = std::ptrdiff_t{ch.a.out_w} * kBlock;
  for (std::int32_t left = (columns.last - columns.first) / 2; left > 0; --left) {
    tile<kRows, 2, kStride>(window, x, x_row, y, y_row);
    x += 2 * kStride * kBlock;
    y += 2 * kBlock;
  }
  if ((columns.last - columns.first) % 2 != 0) {
    tile<kRows, 1, kStride>(window, x, x_row, y, y_row);
  }
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
  std::int32_t oy = rows.first;
  for (; oy + 2 <= rows.last; oy += 2) {
    whole_outputs<2, kStride>(ch, oy, columns);
  }
  if (oy < rows.last) {
    whole_outputs<1, kStride>(ch, oy, columns);
  }
}

void channels_any(const Channels& ch) {
  for (std::int32_t oy = 0; oy < ch.a.out_h; ++oy) {
    edge_outputs(ch, oy, 0, ch.a.out_w);
  }
}

[[gnu::noinline]] void all_channels(const DepthwiseArgs& a, const Activator& activator,
                                    std::int32_t block, const float* map) {
  const bool is_3x3 = a.kernel_h == 3 && a.kernel_w == 3 && a.stride_h == a.stride_w;
  for (std::int32_t v = 0; v < kBlock / kLanes; v += kVecs) {
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

// A map with its padding, on the stack.
constexpr std::int32_t kPaddedPixels = 96;

class Padded {
 public:
  explicit Padded(const DepthwiseArgs& a) : a_(a), inner_(a) {
    inner_.in_h = (a.out_h - 1) * a.stride_h + a.kernel_h;
    inner_.in_w = (a.out_w - 1) * a.stride_w + a.kernel_w;
    inner_.pad_top = inner_.pad_left = 0;
    rows_ = std::min(a.in_h, inner_.in_h - a.pad_top);
    columns_ = std::min(a.in_w, inner_.in_w - a.pad_left);
    std::fill_n(map_, inner_.in_h * inner_.in_w * kBlock, 0.0f);
  }
  static bool serves(const DepthwiseArgs& a) {
    const std::int32_t h = (a.out_h - 1) * a.stride_h + a.kernel_h;
    const std::int32_t w = (a.out_w - 1) * a.stride_w + a.kernel_w;
    const bool leaves = a.pad_top > 0 || a.pad_left > 0 || h > a.in_h || w > a.in_w;
    return leaves && h <= kPaddedPixels && w <= kPaddedPixels && h * w <= kPaddedPixels;
  }
  [[nodiscard]] const DepthwiseArgs& args() const { return inner_; }
  const float* filled(const float* x) {
    for (std::int32_t i = 0; i < rows_; ++i) {
      const float* from = x + std::ptrdiff_t{i} * a_.in_w * kBlock;
      float* to = map_ + ((i + a_.pad_top) * inner_.in_w + a_.pad_left) * kBlock;
      for (std::int32_t j = 0; j < columns_; ++j, from += kBlock, to += kBlock) {
        store_pair(to, load_pair(from));
      }
    }
    return map_;
  }

 private:
  const DepthwiseArgs& a_;
  DepthwiseArgs inner_;
  std::int32_t rows_, columns_;
  float map_[kPaddedPixels * kBlock];
};

}  // namespace

void depthwise(const DepthwiseArgs& a) {
  const Activator activator(a.activation, a.channels);
  const std::ptrdiff_t plane = std::ptrdiff_t{a.in_h} * a.in_w * kBlock;
  const std::int32_t blocks = blocks_of(a.channels);
  if (Padded::serves(a)) {
    Padded padded(a);
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
