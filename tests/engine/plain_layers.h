// Reference implementations of every layer operation, in double on plain [h][w][c] maps and with
// PyTorch's weight layout. They share no code with the kernels.
#pragma once

#include <cstddef>
#include <vector>

#include "formats/mien_writer.h"

namespace mien::tests {

struct Map {
  std::size_t h = 0, w = 0, c = 0;
  std::vector<double> values;  // [h][w][c]

  Map() = default;
  Map(std::size_t height, std::size_t width, std::size_t channels)
      : h(height), w(width), c(channels), values(height * width * channels) {}
  double& at(std::size_t y, std::size_t x, std::size_t channel) {
    return values[(y * w + x) * c + channel];
  }
  [[nodiscard]] double at(std::size_t y, std::size_t x, std::size_t channel) const {
    return values[(y * w + x) * c + channel];
  }
};

using Bias = std::vector<float>;

// Weight [out, in / groups, kh, kw]; groups is the number of channels (depthwise) or one.
Map plain_conv(const Map& x, const formats::Array& weight, const Bias& bias,
               const formats::LayerOptions& options);
// Weight [out, c * h * w].
Map plain_fully_connected(const Map& x, const formats::Array& weight, const Bias& bias,
                          const formats::LayerOptions& options);
// Weight [out, in, 2].
Map plain_causal_conv(const Map& previous, const Map& x, const formats::Array& weight,
                      const Bias& bias, const formats::LayerOptions& options);

struct LstmState {
  std::vector<double> h, c;
};
Map plain_lstm(const Map& x, const formats::Array& weight_ih, const formats::Array& weight_hh,
               const Bias& bias, LstmState& state);

Map plain_max_pool(const Map& x, std::size_t kernel_h, std::size_t kernel_w,
                   const formats::LayerOptions& options);
// a + the centre slice of b
Map plain_add(const Map& a, const Map& b);
Map plain_activation(Map x, const formats::LayerOptions& options);
Map plain_softmax(Map x);
Map plain_global_average_pool(const Map& x);
// The channels of a, then those of b.
Map plain_concat(const Map& a, const Map& b);
// `channels` channels from `first` on, without the margins of options.padding.
Map plain_slice(const Map& x, std::size_t first, std::size_t channels,
                const formats::LayerOptions& options);

// b may have a single row, column or channel.
Map plain_combine(const Map& a, const Map& b, double (*function)(double, double));
Map plain_resize(const Map& x, std::size_t h, std::size_t w, formats::ResizeGrid grid,
                 formats::ResizeSampling sampling);
// Of `shape` only the size counts.
Map plain_rearrange(const Map& x, formats::ReadingOrder order, const Map& shape);
Map plain_normalize(Map x, double epsilon);

}  // namespace mien::tests
