// Computes every layer operation in double precision.
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
    case LayerActivation::kHardSwish:
      return x <= -3 ? 0 : x >= 3 ? x : x * (x + 3) / 6;
    case LayerActivation::kSwish:
      return x / (1 + std::exp(-x));
    case LayerActivation::kGelu:
      return x * (1 + std::erf(x / std::sqrt(2.0))) / 2;
    case LayerActivation::kGeluTanh:
      return x * (1 + std::tanh(0.7978845608028654 * (x + 0.044715 * x * x * x))) / 2;
    case LayerActivation::kErf:
      return std::erf(x);
    case LayerActivation::kExp:
      return std::exp(x);
    case LayerActivation::kSqrt:
      return std::sqrt(x);
  }
  return x;
}

std::size_t windows(std::size_t size, std::size_t kernel, std::size_t stride, std::size_t padding,
                    bool ceil_mode) {
  return (size + padding - kernel + (ceil_mode ? stride - 1 : 0)) / stride + 1;
}

Map filtered(const Map& x, std::size_t kernel_h, std::size_t kernel_w, std::size_t channels,
             const LayerOptions& o) {
  return {windows(x.h, kernel_h, o.stride_y, std::size_t{o.padding.top} + o.padding.bottom,
                  o.ceil_mode),
          windows(x.w, kernel_w, o.stride_x, std::size_t{o.padding.left} + o.padding.right,
                  o.ceil_mode),
          channels};
}

// Calls visit(ky, kx, y, x) for the positions of a window that lie inside the map.
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
  Map y = filtered(x, kh, kw, weight.shape[0], o);
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
  Map y = filtered(x, kernel_h, kernel_w, x.c, o);
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

Map plain_combine(const Map& a, const Map& b, double (*function)(double, double)) {
  Map y = a;
  for_elements(y, [&](std::size_t row, std::size_t column, std::size_t c, double& value) {
    value = function(value, b.at(row % b.h, column % b.w, c % b.c));
  });
  return y;
}

namespace {

double place_in(std::size_t i, std::size_t in, std::size_t out, formats::ResizeGrid grid) {
  const auto from = static_cast<double>(in), to = static_cast<double>(out);
  const auto at = static_cast<double>(i);
  switch (grid) {
    case formats::ResizeGrid::kHalfPixel:
      return (at + 0.5) * from / to - 0.5;
    case formats::ResizeGrid::kAsymmetric:
      return at * from / to;
    case formats::ResizeGrid::kAlignCorners:
      break;
  }
  return out > 1 ? at * (from - 1) / (to - 1) : 0;
}

double rounded(double at, formats::ResizeSampling sampling) {
  switch (sampling) {
    case formats::ResizeSampling::kRoundHalfDown:
      return std::ceil(at - 0.5 - 1e-9);
    case formats::ResizeSampling::kRoundHalfUp:
      return std::floor(at + 0.5 + 1e-9);
    case formats::ResizeSampling::kFloor:
      return std::floor(at + 1e-9);
    case formats::ResizeSampling::kCeil:
      return std::ceil(at - 1e-9);
    case formats::ResizeSampling::kBilinear:
      break;
  }
  return at;
}

}  // namespace

Map plain_resize(const Map& x, std::size_t h, std::size_t w, formats::ResizeGrid grid,
                 formats::ResizeSampling sampling) {
  Map y(h, w, x.c);
  for_elements(y, [&](std::size_t row, std::size_t column, std::size_t c, double& value) {
    const auto inside = [&](std::size_t i, std::size_t in, std::size_t out) {
      const double at = rounded(place_in(i, in, out, grid), sampling);
      return std::clamp(at, 0.0, static_cast<double>(in - 1));
    };
    const double v = inside(row, x.h, h), u = inside(column, x.w, w);
    value = 0;
    for (std::size_t i = 0; i < x.h; ++i) {
      for (std::size_t j = 0; j < x.w; ++j) {
        const double near_v = std::max(0.0, 1 - std::abs(v - static_cast<double>(i)));
        const double near_u = std::max(0.0, 1 - std::abs(u - static_cast<double>(j)));
        value += near_v * near_u * x.at(i, j, c);
      }
    }
  });
  return y;
}

Map plain_rearrange(const Map& x, formats::ReadingOrder order, const Map& shape) {
  const char* names[] = {"hwc", "hcw", "whc", "wch", "chw", "cwh"};
  const char* name = names[static_cast<std::size_t>(order)];
  const auto size = [&](char axis) { return axis == 'h' ? x.h : axis == 'w' ? x.w : x.c; };
  Map y(shape.h, shape.w, shape.c);
  for (std::size_t element = 0; element < y.values.size(); ++element) {
    std::size_t rest = element, h = 0, w = 0, c = 0;
    for (int i = 2; i >= 0; --i) {
      std::size_t& at = name[i] == 'h' ? h : name[i] == 'w' ? w : c;
      at = rest % size(name[i]);
      rest /= size(name[i]);
    }
    y.values[element] = x.at(h, w, c);
  }
  return y;
}

Map plain_normalize(Map x, double epsilon) {
  for (std::size_t p = 0; p < x.h * x.w; ++p) {
    double* pixel = x.values.data() + p * x.c;
    double mean = 0, square = 0;
    for (std::size_t c = 0; c < x.c; ++c) {
      mean += pixel[c] / static_cast<double>(x.c);
    }
    for (std::size_t c = 0; c < x.c; ++c) {
      square += (pixel[c] - mean) * (pixel[c] - mean) / static_cast<double>(x.c);
    }
    for (std::size_t c = 0; c < x.c; ++c) {
      pixel[c] = (pixel[c] - mean) / std::sqrt(square + epsilon);
    }
  }
  return x;
}

}  // namespace mien::tests
