// A 3x3 depthwise convolution of one image in fp32, one vector of channels at a time, used by the
// units of a block. It computes rows of its input when it needs them, so that only a few rows exist
// and stay in the first-level cache.
#pragma once

#include <vector>

#include "norm.h"

namespace mien::training {

constexpr std::size_t kTaps = 9;
constexpr Limits kRelu6 = {0.0f, 6.0f};
using Kernel = std::array<Lanes, kTaps>;

extern "C" {
struct DepthwiseShape {
  std::size_t images, height, width, channels, stride, padding;
};
}

struct Geometry {
  explicit Geometry(DepthwiseShape s)
      : shape(s),
        padded_width(s.width + 2 * s.padding),
        padded_height(s.height + 2 * s.padding),
        out_width((padded_width - 3) / s.stride + 1),
        out_height((padded_height - 3) / s.stride + 1) {}

  std::size_t pixels() const { return shape.height * shape.width; }
  std::size_t out_pixels() const { return out_height * out_width; }
  Map in() const { return {shape.images * pixels(), shape.channels}; }
  Map out() const { return {shape.images * out_pixels(), shape.channels}; }

  DepthwiseShape shape;
  std::size_t padded_width, padded_height, out_width, out_height;
};

// A vector of channels of the kernel; weights are [9][channels].
inline Kernel kernel_of(const float* weights, std::size_t channels, std::size_t c,
                        std::size_t count) {
  Kernel out;
  for (std::size_t k = 0; k < kTaps; ++k) {
    out[k] = load_some(weights + k * channels + c, count);
  }
  return out;
}

// The latest rows of a vector of channels of a map, padded with zeros.
class Rows {
 public:
  explicit Rows(const Geometry& g)
      : width_(g.padded_width), padding_(g.shape.padding), values_(kKept * width_) {}
  Lanes* whole(std::size_t padded_row) { return &values_[padded_row % kKept * width_]; }
  Lanes* inner(std::size_t row) { return whole(row + padding_) + padding_; }
  void clear(std::size_t padded_row) { std::fill_n(whole(padded_row), width_, Lanes{}); }

 private:
  static constexpr std::size_t kKept = 4;
  std::size_t width_, padding_;
  std::vector<Lanes> values_;
};

// The rows of the padded input that a row of the output needs, which move down with it. begin(row)
// is called when a row of the input is first needed, end(row) when it is no longer needed.
class RowWindow {
 public:
  explicit RowWindow(const Geometry& g) : g_(g) {}

  template <typename Begin>
  void advance_to(std::size_t out_row, Rows& seen, Begin begin) {
    for (; begun_ < out_row * g_.shape.stride + 3; ++begun_) {
      if (inside(begun_)) {
        begin(begun_ - g_.shape.padding);
      } else {
        seen.clear(begun_);
      }
    }
  }
  template <typename End>
  void retire(std::size_t out_row, End end) {
    for (; ended_ < (out_row + 1) * g_.shape.stride; ++ended_) {
      if (inside(ended_)) {
        end(ended_ - g_.shape.padding);
      }
    }
  }
  template <typename Begin, typename End>
  void finish(Begin begin, End end) {
    for (; ended_ < g_.padded_height; ++ended_) {
      if (inside(ended_)) {
        if (ended_ >= begun_) {
          begin(ended_ - g_.shape.padding);
        }
        end(ended_ - g_.shape.padding);
      }
    }
  }

 private:
  bool inside(std::size_t row) const {
    return row >= g_.shape.padding && row < g_.shape.height + g_.shape.padding;
  }

  const Geometry& g_;
  std::size_t begun_ = 0, ended_ = 0;
};

// Computes a vector of channels of one image's output, and the sums of its values and their
// squares. fill(row) computes a row of `seen`, the input.
template <typename T, typename Fill>
void convolve(const Geometry& g, Rows& seen, const Kernel& kernel, T* convolved, std::size_t count,
              Lanes& values, Lanes& squares, Fill fill) {
  RowWindow rows(g);
  for (std::size_t y = 0; y < g.out_height; ++y) {
    rows.advance_to(y, seen, fill);
    const std::size_t first = y * g.shape.stride;
    const std::array<const Lanes*, 3> from = {seen.whole(first), seen.whole(first + 1),
                                              seen.whole(first + 2)};
    for (std::size_t x = 0; x < g.out_width; ++x, convolved += g.shape.channels) {
      Lanes sum = {};
      for (std::size_t k = 0; k < kTaps; ++k) {
        sum += from[k / 3][x * g.shape.stride + k % 3] * kernel[k];
      }
      values += sum;
      squares += sum * sum;
      store_some(convolved, sum, count);
    }
  }
}

// The backward pass. slope_at(pixel) is the gradient of the output. fill(row) recomputes a row of
// `seen`; finish(row) is called when a row of `gradient`, the gradient of `seen`, is complete. The
// gradient of the kernel is added to `dkernel`.
template <typename SlopeAt, typename Fill, typename Finish>
void slide_backward(const Geometry& g, Rows& seen, Rows& gradient, const Kernel& kernel,
                    Kernel& dkernel, SlopeAt slope_at, Fill fill, Finish finish) {
  RowWindow rows(g);
  const auto begin = [&](std::size_t row) {
    fill(row);
    gradient.clear(row + g.shape.padding);
  };
  std::size_t pixel = 0;
  for (std::size_t y = 0; y < g.out_height; ++y) {
    rows.advance_to(y, seen, begin);
    const std::size_t first = y * g.shape.stride;
    const std::array<const Lanes*, 3> from = {seen.whole(first), seen.whole(first + 1),
                                              seen.whole(first + 2)};
    const std::array<Lanes*, 3> to = {gradient.whole(first), gradient.whole(first + 1),
                                      gradient.whole(first + 2)};
    Kernel part = dkernel;
    for (std::size_t x = 0; x < g.out_width; ++x) {
      const Lanes slope = slope_at(pixel++);
      for (std::size_t k = 0; k < kTaps; ++k) {
        const std::size_t at = x * g.shape.stride + k % 3;
        to[k / 3][at] += slope * kernel[k];
        part[k] += slope * from[k / 3][at];
      }
    }
    dkernel = part;
    rows.retire(y, finish);
  }
  rows.finish(begin, finish);
}

// The gradient of the convolution's output, from dy, the gradient of y = ReLU6(norm(output)).
// Computes the gradients of the norm's weight and bias.
template <typename T>
class OutputGradient {
 public:
  OutputGradient(const Geometry& g, const T* dy, const T* convolved, Norm norm, float* dweight,
                 float* dbias)
      : dy_(dy),
        convolved_(convolved),
        line_(g.shape.channels, norm),
        norm_backward_(g.out(), norm, line_,
                       sum_gradients(dy, convolved, g.out(), norm, line_, kRelu6), dweight, dbias) {
  }

  void prefetch_maps(std::size_t offset, std::size_t count) const {
    prefetch(convolved_ + offset, count);
    prefetch(dy_ + offset, count);
  }
  // offset: of channel c of the pixel in the maps.
  Lanes at(std::size_t offset, std::size_t c, std::size_t count) const {
    const Lanes v = load_some(convolved_ + offset, count);
    const Lanes dz = passed(line_.at(c, v), kRelu6, load_some(dy_ + offset, count));
    return norm_backward_.at(line_, c, dz, v);
  }

 private:
  const T *dy_, *convolved_;
  Line line_;
  NormBackward norm_backward_;
};

// Adds a vector of channels of the kernel's gradient to [9][channels].
inline void add_kernel(std::vector<double>& total, const Kernel& part, std::size_t channels,
                       std::size_t c, std::size_t count) {
  for (std::size_t k = 0; k < kTaps; ++k) {
    for (std::size_t lane = 0; lane < count; ++lane) {
      total[k * channels + c + lane] += part[k][lane];
    }
  }
}

}  // namespace mien::training
