// Creates weight files from JSON descriptions.
#include "tests/formats/description.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "formats/mien_writer.h"

namespace mien::formats {
namespace {

using nlohmann::json;

// The same numbers as in describe.py.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed) {}

  Array array(const json& shape) {
    Array result{shape.get<std::vector<std::uint32_t>>(), {}};
    std::size_t count = 1;
    for (const std::uint32_t dim : result.shape) {
      count *= dim;
    }
    for (std::size_t i = 0; i < count; ++i) {
      result.values.push_back(next());
    }
    return result;
  }

 private:
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return (static_cast<float>(state_ >> 8) - 8388608.0f) / 4194304.0f;
  }

  std::uint32_t state_;
};

LayerActivation activation_named(const std::string& name) {
  const std::vector<std::string> names = {"none",    "relu",      "relu6",   "leaky_relu", "prelu",
                                          "sigmoid", "tanh",      "clamp01", "hard_swish", "swish",
                                          "gelu",    "gelu_tanh", "erf",     "exp",        "sqrt"};
  const auto at = std::find(names.begin(), names.end(), name);
  return static_cast<LayerActivation>(at - names.begin());
}

std::uint16_t index_of(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<std::uint16_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

void add_resize(NetworkWriter& net, const json& layer) {
  const std::uint16_t grid = index_of(layer["grid"], {"half_pixel", "asymmetric", "align_corners"});
  const std::uint16_t sampling = index_of(
      layer["sampling"], {"round_half_down", "round_half_up", "floor", "ceil", "bilinear"});
  const json& size = layer["size"];
  net.resize(layer["x"], size[0], size[1], static_cast<ResizeGrid>(grid),
             static_cast<ResizeSampling>(sampling));
}

void add_rearrange(NetworkWriter& net, const json& layer) {
  const std::uint16_t order = index_of(layer["order"], {"hwc", "hcw", "whc", "wch", "chw", "cwh"});
  const json& shape = layer["shape"];
  net.rearrange(layer["x"], static_cast<ReadingOrder>(order), {shape[0], shape[1], shape[2]});
}

// A number for both directions, or [rows, columns].
std::pair<std::uint16_t, std::uint16_t> pair_of(const json& value) {
  return value.is_array() ? std::pair<std::uint16_t, std::uint16_t>(value[0], value[1])
                          : std::pair<std::uint16_t, std::uint16_t>(value, value);
}

LayerOptions options_of(const json& layer) {
  const json given = layer.value("options", json::object());
  LayerOptions options;
  options.activation = activation_named(given.value("activation", "none"));
  options.alpha = given.value("alpha", 0.0f);
  options.input_bound = given.value("input_bound", 0.0f);
  options.ceil_mode = given.value("ceil_mode", false);
  std::tie(options.stride_y, options.stride_x) = pair_of(given.value("stride", json(1)));
  const json padding = given.value("padding", json::array({0, 0, 0, 0}));
  options.padding = {padding[0], padding[1], padding[2], padding[3]};
  return options;
}

void add_layer(NetworkWriter& net, const json& layer, Numbers& numbers) {
  LayerOptions options = options_of(layer);
  const std::string op = layer["op"];
  const LayerIndex x = layer["x"];
  std::vector<Array> weights;
  for (const json& shape : layer.value("weights", json::array())) {
    weights.push_back(numbers.array(shape));
  }
  const auto vector_of = [&](const char* key) {
    return layer.contains(key) ? numbers.array(json::array({layer[key]})).values
                               : std::vector<float>();
  };
  const std::vector<float> bias = vector_of("bias");
  options.slopes = vector_of("slopes");
  if (op == "conv2d") {
    net.conv2d(x, weights[0], bias, options);
  } else if (op == "depthwise") {
    net.depthwise(x, weights[0], bias, options);
  } else if (op == "pointwise") {
    net.pointwise(x, weights[0], bias, options);
  } else if (op == "fully_connected") {
    net.fully_connected(x, weights[0], bias, options);
  } else if (op == "causal_conv") {
    net.causal_conv(x, weights[0], bias, options);
  } else if (op == "lstm") {
    net.lstm(x, weights[0], weights[1], bias, options);
  } else if (op == "max_pool") {
    const auto [kernel_h, kernel_w] = pair_of(layer["kernel"]);
    net.max_pool(x, kernel_h, kernel_w, options);
  } else if (op == "add") {
    net.add(x, layer["b"], options);
  } else if (op == "global_average_pool") {
    net.global_average_pool(x);
  } else if (op == "concat") {
    net.concat(x, layer["b"]);
  } else if (op == "slice") {
    net.slice(x, layer["first_channel"], layer["channels"], options);
  } else if (op == "multiply") {
    net.multiply(x, layer["b"]);
  } else if (op == "divide") {
    net.divide(x, layer["b"]);
  } else if (op == "broadcast_add") {
    net.broadcast_add(x, layer["b"]);
  } else if (op == "resize") {
    add_resize(net, layer);
  } else if (op == "rearrange") {
    add_rearrange(net, layer);
  } else if (op == "normalize") {
    net.normalize(x, options);
  } else if (op == "activation") {
    net.activation(x, options);
  } else {
    net.softmax(x, options);
  }
}

}  // namespace

mien_error_detail write_described(const std::string& description_path,
                                  std::vector<std::byte>* file) {
  std::ifstream in(description_path);
  const json description = json::parse(in);
  Numbers numbers(description["seed"]);
  MienWriter writer;
  for (const json& network : description["networks"]) {
    const json& input = network["input"];
    NetworkWriter& net = writer.network(network["name"], {input[0], input[1], input[2]},
                                        network.value("any_size", false));
    for (const json& layer : network["layers"]) {
      add_layer(net, layer, numbers);
    }
    for (const json& value : network["outputs"]) {
      net.output(value);
    }
  }
  for (const json& constant : description.value("constants", json::array())) {
    const DataType type = constant["type"] == "fp16" ? DataType::kFloat16 : DataType::kFloat32;
    writer.constant(constant["name"], numbers.array(constant["shape"]), type);
  }
  const json metadata = description.value("metadata", json::object());
  for (const auto& [key, value] : metadata.items()) {
    writer.metadata(key, value);
  }
  return writer.finish(file);
}

}  // namespace mien::formats
