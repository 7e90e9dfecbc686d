#include "tests/engine/plain_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mien::tests {

using formats::Array;
using formats::LayerActivation;
using formats::LayerOptions;

namespace {

double activated(double x, const LayerOptions& options, std::size_t channel) {
  switch (options.activation) {
    case LayerActivation::kNone:
      return x;
    case LayerActivation::kRelu:
      return x > 0 ? x : 0;
    case LayerActivation::kRelu6:
      return x < 0 ? 0 : x > 6 ? 6 : x;
    case LayerActivation::kLeakyRelu:
      return x > 0 ? x : static_cast<double>(options.alpha) * x;
    case LayerActivation::kPrelu:
      return x > 0 ? x : static_cast<double>(options.slopes[channel]) * x;
    case LayerActivation::kSigmoid:
      return 1 / (1 + std::exp(-x));
    case LayerActivation::kTanh:
      return std::tanh(x);
    case LayerActivation::kClamp01:
      return x < 0 ? 0 : x > 1 ? 1 : x;
  }
  return x;
}

std::size_t windows(std::size_t size, std::size_t kernel, std::size_t stride, std::size_t padding,
                    bool ceil_mode) {
  return (size + padding - kernel + (ceil_mode ? stride - 1 : 0)) / stride + 1;
}

Map slid(const Map& x, std::size_t kernel_h, std::size_t kernel_w, std::size_t channels,
         const LayerOptions& o) {
  return {windows(x.h, kernel_h, o.stride_y, std::size_t{o.padding.top} + o.padding.bottom,
                  o.ceil_mode),
          windows(x.w, kernel_w, o.stride_x, std::size_t{o.padding.left} + o.padding.right,
                  o.ceil_mode),
          channels};
}

// Calls visit(ky, kx, y, x) for the positions of a window that lie on the map.
template <class Visit>
void for_window(const Map& map, std::size_t out_y, std::size_t out_x, std::size_t kernel_h,
                std::size_t kernel_w, const LayerOptions& o, const Visit& visit) {
  for (std::size_t ky = 0; ky < kernel_h; ++ky) {
    for (std::size_t kx = 0; kx < kernel_w; ++kx) {
      const std::size_t y = out_y * o.stride_y + ky, x = out_x * o.stride_x + kx;
      if (y >= o.padding.top && y < map.h + o.padding.top && x >= o.padding.left &&
          x < map.w + o.padding.left) {
        visit(ky, kx, y - o.padding.top, x - o.padding.left);
      }
    }
  }
}

// Calls write(y, x, channel, value&) for every element.
template <class Write>
void for_elements(Map& map, const Write& write) {
  for (std::size_t y = 0; y < map.h; ++y) {
    for (std::size_t x = 0; x < map.w; ++x) {
      for (std::size_t c = 0; c < map.c; ++c) {
        write(y, x, c, map.at(y, x, c));
      }
    }
  }
}

double element(const Array& weight, std::size_t row, std::size_t column) {
  return weight.values[row * (weight.values.size() / weight.shape[0]) + column];
}

}  // namespace

Map plain_conv(const Map& x, const Array& weight, const Bias& bias, const LayerOptions& o) {
  const std::size_t kh = weight.shape[2], kw = weight.shape[3], per_group = weight.shape[1];
  const std::size_t outputs_per_group = weight.shape[0] / (x.c / per_group);
  Map y = slid(x, kh, kw, weight.shape[0], o);
  for_elements(y, [&](std::size_t oy, std::size_t ox, std::size_t c, double& value) {
    double sum = bias[c];
    for_window(x, oy, ox, kh, kw, o,
               [&](std::size_t ky, std::size_t kx, std::size_t iy, std::size_t ix) {
                 for (std::size_t i = 0; i < per_group; ++i) {
                   sum += element(weight, c, (i * kh + ky) * kw + kx) *
                          x.at(iy, ix, c / outputs_per_group * per_group + i);
                 }
               });
    value = activated(sum, o, c);
  });
  return y;
}

Map plain_fully_connected(const Map& x, const Array& weight, const Bias& bias,
                          const LayerOptions& o) {
  Map y(1, 1, weight.shape[0]);
  for (std::size_t out = 0; out < y.c; ++out) {
    double sum = bias[out];
    for (std::size_t c = 0; c < x.c; ++c) {
      for (std::size_t p = 0; p < x.h * x.w; ++p) {
        sum += element(weight, out, c * x.h * x.w + p) * x.values[p * x.c + c];
      }
    }
    y.values[out] = activated(sum, o, out);
  }
  return y;
}

Map plain_causal_conv(const Map& previous, const Map& x, const Array& weight, const Bias& bias,
                      const LayerOptions& o) {
  Map y(1, 1, weight.shape[0]);
  for (std::size_t out = 0; out < y.c; ++out) {
    double sum = bias[out];
    for (std::size_t i = 0; i < x.c; ++i) {
      sum += element(weight, out, 2 * i) * previous.values[i] +
             element(weight, out, 2 * i + 1) * x.values[i];
    }
    y.values[out] = activated(sum, o, out);
  }
  return y;
}

Map plain_lstm(const Map& x, const Array& weight_ih, const Array& weight_hh, const Bias& bias,
               LstmState& state) {
  const std::size_t hidden = weight_hh.shape[1];
  std::vector<double> gates(4 * hidden);
  for (std::size_t row = 0; row < gates.size(); ++row) {
    gates[row] = bias[row];
    for (std::size_t i = 0; i < x.c; ++i) {
      gates[row] += element(weight_ih, row, i) * x.values[i];
    }
    for (std::size_t i = 0; i < hidden; ++i) {
      gates[row] += element(weight_hh, row, i) * state.h[i];
    }
  }
  const auto sigmoid = [](double v) { return 1 / (1 + std::exp(-v)); };
  Map y(1, 1, hidden);
  for (std::size_t j = 0; j < hidden; ++j) {
    state.c[j] = sigmoid(gates[hidden + j]) * state.c[j] +
                 sigmoid(gates[j]) * std::tanh(gates[2 * hidden + j]);
    state.h[j] = sigmoid(gates[3 * hidden + j]) * std::tanh(state.c[j]);
    y.values[j] = state.h[j];
  }
  return y;
}

Map plain_max_pool(const Map& x, std::size_t kernel_h, std::size_t kernel_w,
                   const LayerOptions& o) {
  Map y = slid(x, kernel_h, kernel_w, x.c, o);
  for_elements(y, [&](std::size_t oy, std::size_t ox, std::size_t c, double& value) {
    value = -std::numeric_limits<double>::infinity();
    for_window(x, oy, ox, kernel_h, kernel_w, o,
               [&](std::size_t, std::size_t, std::size_t iy, std::size_t ix) {
                 value = std::max(value, x.at(iy, ix, c));
               });
  });
  return y;
}

Map plain_add(const Map& a, const Map& b) {
  Map y = a;
  for_elements(y, [&](std::size_t row, std::size_t column, std::size_t c, double& value) {
    value += b.at(row + (b.h - a.h) / 2, column + (b.w - a.w) / 2, c);
  });
  return y;
}

Map plain_activation(Map x, const LayerOptions& o) {
  for_elements(x, [&](std::size_t, std::size_t, std::size_t c, double& value) {
    value = activated(value, o, c);
  });
  return x;
}

Map plain_softmax(Map x) {
  for (std::size_t p = 0; p < x.h * x.w; ++p) {
    double* pixel = x.values.data() + p * x.c;
    const double largest = *std::max_element(pixel, pixel + x.c);
    double sum = 0;
    for (std::size_t c = 0; c < x.c; ++c) {
      sum += std::exp(pixel[c] - largest);
    }
    for (std::size_t c = 0; c < x.c; ++c) {
      pixel[c] = std::exp(pixel[c] - largest) / sum;
    }
  }
  return x;
}

Map plain_global_average_pool(const Map& x) {
  Map y(1, 1, x.c);
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    y.values[i % x.c] += x.values[i] / static_cast<double>(x.h * x.w);
  }
  return y;
}

Map plain_concat(const Map& a, const Map& b) {
  Map y(a.h, a.w, a.c + b.c);
  for_elements(y, [&](std::size_t row, std::size_t column, std::size_t c, double& value) {
    value = c < a.c ? a.at(row, column, c) : b.at(row, column, c - a.c);
  });
  return y;
}

Map plain_slice(const Map& x, std::size_t first, std::size_t channels, const LayerOptions& o) {
  Map y(x.h - o.padding.top - o.padding.bottom, x.w - o.padding.left - o.padding.right, channels);
  for_elements(y, [&](std::size_t row, std::size_t column, std::size_t c, double& value) {
    value = x.at(row + o.padding.top, column + o.padding.left, first + c);
  });
  return y;
}

}  // namespace mien::tests
