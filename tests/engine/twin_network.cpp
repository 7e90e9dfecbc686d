// Builds a random network in a weight file and of plain layers.
#include "tests/engine/twin_network.h"

#include <cmath>
#include <utility>

#include "formats/fp16.h"

namespace mien::tests {

using formats::Array;
using formats::LayerActivation;

TwinNetwork::TwinNetwork(formats::NetworkWriter& writer, formats::InputShape input, unsigned seed)
    : writer_(writer), random_(seed), probe_{Map(input.height, input.width, input.channels)} {}

// Scaled so that maps keep the magnitude of their input, and exact in fp16.
Array TwinNetwork::weights(std::vector<std::uint32_t> shape, std::size_t fan_in) {
  Array array{std::move(shape), {}};
  std::size_t count = 1;
  for (const std::uint32_t dim : array.shape) {
    count *= dim;
  }
  std::normal_distribution<float> normal(0.0f, 1.0f / std::sqrt(static_cast<float>(fan_in)));
  for (std::size_t i = 0; i < count; ++i) {
    array.values.push_back(formats::float_from_fp16(formats::fp16_from_float(normal(random_))));
  }
  return array;
}

Bias TwinNetwork::bias(std::size_t outputs) {
  return weights({static_cast<std::uint32_t>(outputs)}, 16).values;
}

void TwinNetwork::add_slopes(Options& options, std::size_t channels) {
  if (options.activation == LayerActivation::kPrelu) {
    options.slopes = bias(channels);
  }
}

TwinNetwork::Index TwinNetwork::append(Index index, Evaluate evaluate) {
  evaluations_.push_back(std::move(evaluate));
  probe_.push_back(evaluations_.back()(probe_));
  reset();
  return index;
}

TwinNetwork::Index TwinNetwork::conv2d(Index x, std::uint32_t outputs, std::uint32_t kernel_h,
                                       std::uint32_t kernel_w, Options options) {
  const auto inputs = static_cast<std::uint32_t>(value(x).c);
  const Array w =
      weights({outputs, inputs, kernel_h, kernel_w}, std::size_t{inputs} * kernel_h * kernel_w);
  const Bias b = bias(outputs);
  add_slopes(options, outputs);
  return append(writer_.conv2d(x, w, b, options), [=](const std::vector<Map>& values) {
    return plain_conv(values[x], w, b, options);
  });
}

TwinNetwork::Index TwinNetwork::depthwise(Index x, std::uint32_t kernel_h, std::uint32_t kernel_w,
                                          Options options) {
  const auto channels = static_cast<std::uint32_t>(value(x).c);
  const Array w = weights({channels, 1, kernel_h, kernel_w}, std::size_t{kernel_h} * kernel_w);
  const Bias b = bias(channels);
  add_slopes(options, channels);
  return append(writer_.depthwise(x, w, b, options), [=](const std::vector<Map>& values) {
    return plain_conv(values[x], w, b, options);
  });
}

TwinNetwork::Index TwinNetwork::pointwise(Index x, std::uint32_t outputs, Options options) {
  const auto inputs = static_cast<std::uint32_t>(value(x).c);
  const Array w = weights({outputs, inputs, 1, 1}, inputs);
  const Bias b = bias(outputs);
  add_slopes(options, outputs);
  return append(writer_.pointwise(x, w, b, options), [=](const std::vector<Map>& values) {
    return plain_conv(values[x], w, b, options);
  });
}

TwinNetwork::Index TwinNetwork::fully_connected(Index x, std::uint32_t outputs, Options options) {
  const std::size_t inputs = value(x).values.size();
  const Array w = weights({outputs, static_cast<std::uint32_t>(inputs)}, inputs);
  const Bias b = bias(outputs);
  add_slopes(options, outputs);
  return append(writer_.fully_connected(x, w, b, options), [=](const std::vector<Map>& values) {
    return plain_fully_connected(values[x], w, b, options);
  });
}

TwinNetwork::Index TwinNetwork::causal_conv(Index x, std::uint32_t outputs, Options options) {
  const auto inputs = static_cast<std::uint32_t>(value(x).c);
  const Array w = weights({outputs, inputs, 2}, 2 * std::size_t{inputs});
  const Bias b = bias(outputs);
  add_slopes(options, outputs);
  const Index index = writer_.causal_conv(x, w, b, options);
  return append(index, [=, this](const std::vector<Map>& values) {
    Map& previous = previous_.try_emplace(index, 1, 1, inputs).first->second;
    Map y = plain_causal_conv(previous, values[x], w, b, options);
    previous = values[x];
    return y;
  });
}

TwinNetwork::Index TwinNetwork::lstm(Index x, std::uint32_t hidden) {
  const auto inputs = static_cast<std::uint32_t>(value(x).c);
  const Array ih = weights({4 * hidden, inputs}, inputs),
              hh = weights({4 * hidden, hidden}, hidden);
  const Bias b = bias(4 * std::size_t{hidden});
  const Index index = writer_.lstm(x, ih, hh, b);
  return append(index, [=, this](const std::vector<Map>& values) {
    const std::vector<double> zeros(hidden);
    LstmState& cell = cells_.try_emplace(index, LstmState{zeros, zeros}).first->second;
    return plain_lstm(values[x], ih, hh, b, cell);
  });
}

TwinNetwork::Index TwinNetwork::max_pool(Index x, std::uint32_t kernel_h, std::uint32_t kernel_w,
                                         Options options) {
  return append(writer_.max_pool(x, kernel_h, kernel_w, options),
                [=](const std::vector<Map>& values) {
                  return plain_max_pool(values[x], kernel_h, kernel_w, options);
                });
}

TwinNetwork::Index TwinNetwork::add(Index a, Index b) {
  return append(writer_.add(a, b),
                [=](const std::vector<Map>& values) { return plain_add(values[a], values[b]); });
}

TwinNetwork::Index TwinNetwork::activation(Index x, Options options) {
  add_slopes(options, value(x).c);
  return append(writer_.activation(x, options), [=](const std::vector<Map>& values) {
    return plain_activation(values[x], options);
  });
}

TwinNetwork::Index TwinNetwork::softmax(Index x) {
  return append(writer_.softmax(x),
                [=](const std::vector<Map>& values) { return plain_softmax(values[x]); });
}

TwinNetwork::Index TwinNetwork::global_average_pool(Index x) {
  return append(writer_.global_average_pool(x), [=](const std::vector<Map>& values) {
    return plain_global_average_pool(values[x]);
  });
}

TwinNetwork::Index TwinNetwork::concat(Index a, Index b) {
  return append(writer_.concat(a, b),
                [=](const std::vector<Map>& values) { return plain_concat(values[a], values[b]); });
}

TwinNetwork::Index TwinNetwork::slice(Index x, std::uint16_t first_channel, std::uint32_t channels,
                                      Options options) {
  return append(writer_.slice(x, first_channel, channels, options),
                [=](const std::vector<Map>& values) {
                  return plain_slice(values[x], first_channel, channels, options);
                });
}

TwinNetwork::Index TwinNetwork::multiply(Index a, Index b) {
  return append(writer_.multiply(a, b), [=](const std::vector<Map>& values) {
    return plain_combine(values[a], values[b], [](double x, double y) { return x * y; });
  });
}

TwinNetwork::Index TwinNetwork::divide(Index a, Index b) {
  return append(writer_.divide(a, b), [=](const std::vector<Map>& values) {
    return plain_combine(values[a], values[b], [](double x, double y) { return x / y; });
  });
}

TwinNetwork::Index TwinNetwork::broadcast_add(Index a, Index b) {
  return append(writer_.broadcast_add(a, b), [=](const std::vector<Map>& values) {
    return plain_combine(values[a], values[b], [](double x, double y) { return x + y; });
  });
}

TwinNetwork::Index TwinNetwork::resize(Index x, std::uint32_t height, std::uint32_t width,
                                       formats::ResizeGrid grid, formats::ResizeSampling sampling) {
  return append(writer_.resize(x, height, width, grid, sampling),
                [=](const std::vector<Map>& values) {
                  return plain_resize(values[x], height, width, grid, sampling);
                });
}

TwinNetwork::Index TwinNetwork::rearrange(Index x, formats::ReadingOrder order,
                                          formats::InputShape shape) {
  return append(writer_.rearrange(x, order, shape), [=](const std::vector<Map>& values) {
    return plain_rearrange(values[x], order, Map(shape.height, shape.width, shape.channels));
  });
}

TwinNetwork::Index TwinNetwork::normalize(Index x, float epsilon) {
  Options options;
  options.alpha = epsilon;
  return append(writer_.normalize(x, options), [=](const std::vector<Map>& values) {
    return plain_normalize(values[x], static_cast<double>(epsilon));
  });
}

void TwinNetwork::output(Index x) {
  writer_.output(x);
  outputs_.push_back(x);
}

Map TwinNetwork::random_input() {
  Map input = probe_[0];
  std::normal_distribution<float> normal;
  for (double& one : input.values) {
    one = normal(random_);
  }
  return input;
}

std::vector<Map> TwinNetwork::run(const Map& input) {
  std::vector<Map> values{input};
  for (const Evaluate& evaluate : evaluations_) {
    values.push_back(evaluate(values));
  }
  return values;
}

void TwinNetwork::reset() {
  previous_.clear();
  cells_.clear();
}

}  // namespace mien::tests
