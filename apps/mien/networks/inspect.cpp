// Prints the content of a weight file as text or JSON.
#include "apps/mien/networks/inspect.h"

#include <mien/engine.h>

#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/mien/networks/model_files.h"
#include "apps/mien/system/json_text.h"

namespace mien::app {
namespace {

using nlohmann::ordered_json;

std::string text(const mien_shape& shape) {
  return std::to_string(shape.height) + "x" + std::to_string(shape.width) + "x" +
         std::to_string(shape.channels);
}

ordered_json array(const mien_shape& shape) { return {shape.height, shape.width, shape.channels}; }

ordered_json layer_json(const LayerInfo& layer) {
  ordered_json json;
  json["op"] = layer.op;
  json["activation"] = layer.activation;
  json["input"] = layer.input;
  if (layer.second_input >= 0) {
    json["second_input"] = layer.second_input;
  }
  if (layer.kernel[0] > 0) {
    json["kernel"] = layer.kernel;
    json["stride"] = layer.stride;
    json["padding"] = layer.padding;
  }
  if (std::strcmp(layer.op, "slice") == 0) {
    json["left_out"] = layer.padding;
    json["first_channel"] = layer.first_channel;
  }
  if (layer.input_bound > 0.0f) {
    json["input_bound"] = layer.input_bound;
  }
  json["output"] = array(layer.output);
  json["parameters"] = layer.parameters;
  json["macs"] = layer.macs;
  return json;
}

ordered_json network_json(const WeightsContent& file, std::int32_t index) {
  const NetworkInfo info = file.network(index);
  ordered_json json;
  json["name"] = info.name;
  json["input"] = array(info.input);
  json["any_size"] = info.any_size != 0;
  json["outputs"] = info.outputs;
  json["parameters"] = info.parameters;
  json["macs"] = info.macs;
  json["weight_bytes"] = info.weight_bytes;
  json["session_bytes"] = info.session_bytes;
  json["arena_bytes"] = info.arena_bytes;
  json["layers"] = ordered_json::array();
  for (std::int32_t i = 0; i < info.layers; ++i) {
    json["layers"].push_back(layer_json(file.layer(index, i)));
  }
  return json;
}

ordered_json file_json(const WeightsContent& file, std::size_t bytes) {
  ordered_json json;
  json["bytes"] = bytes;
  json["metadata"] = ordered_json::object();
  for (std::int32_t i = 0; i < file.metadata_count(); ++i) {
    const MetadataInfo info = file.metadata(i);
    json["metadata"][info.key] = info.text();
  }
  json["constants"] = ordered_json::array();
  for (std::int32_t i = 0; i < file.constant_count(); ++i) {
    const ConstantInfo info = file.constant(i);
    json["constants"].push_back({{"name", info.name},
                                 {"type", info.type},
                                 {"dims", std::vector(info.dims, info.dims + info.rank)}});
  }
  json["networks"] = ordered_json::array();
  for (std::int32_t i = 0; i < file.network_count(); ++i) {
    json["networks"].push_back(network_json(file, i));
  }
  return json;
}

void print_layer(std::int32_t number, const LayerInfo& layer) {
  std::string reads = std::to_string(layer.input);
  if (layer.second_input >= 0) {
    reads.append("+").append(std::to_string(layer.second_input));
  }
  std::string window;
  if (layer.kernel[0] > 0) {
    window = std::to_string(layer.kernel[0]) + "x" + std::to_string(layer.kernel[1]) + " s" +
             std::to_string(layer.stride[0]) + " p" + std::to_string(layer.padding[0]);
  }
  std::printf("  %3d  %-15s %-10s reads %-6s %-10s -> %-12s %9llu parameters %10llu MACs\n", number,
              layer.op, layer.activation, reads.c_str(), window.c_str(), text(layer.output).c_str(),
              static_cast<unsigned long long>(layer.parameters),
              static_cast<unsigned long long>(layer.macs));
}

void print_network(const WeightsContent& file, std::int32_t index) {
  const NetworkInfo info = file.network(index);
  std::printf("network %s: input %s%s, %llu parameters, %.2f M MACs\n", info.name,
              text(info.input).c_str(), info.any_size != 0 ? " or larger" : "",
              static_cast<unsigned long long>(info.parameters),
              static_cast<double>(info.macs) * 1e-6);
  std::printf("  weights %llu bytes, session %llu bytes, arena %llu bytes\n",
              static_cast<unsigned long long>(info.weight_bytes),
              static_cast<unsigned long long>(info.session_bytes),
              static_cast<unsigned long long>(info.arena_bytes));
  for (std::int32_t i = 0; i < info.layers; ++i) {
    print_layer(i + 1, file.layer(index, i));
  }
}

void print_file(const WeightsContent& file, std::size_t bytes) {
  std::printf("%zu bytes\n", bytes);
  for (std::int32_t i = 0; i < file.metadata_count(); ++i) {
    const MetadataInfo info = file.metadata(i);
    std::printf("%s: %.*s\n", info.key, static_cast<int>(info.value_bytes), info.value);
  }
  for (std::int32_t i = 0; i < file.constant_count(); ++i) {
    const ConstantInfo info = file.constant(i);
    std::printf("constant %s: %s", info.name, info.type);
    for (std::int32_t k = 0; k < info.rank; ++k) {
      std::printf(" %u", info.dims[k]);
    }
    std::printf("\n");
  }
  for (std::int32_t i = 0; i < file.network_count(); ++i) {
    print_network(file, i);
  }
}

}  // namespace

void inspect(const InspectOptions& options) {
  const OpenedWeights file({options.file});
  const WeightsContent content(file.weights());
  if (options.json) {
    std::printf("%s\n", json_text(file_json(content, file.bytes())).c_str());
  } else {
    print_file(content, file.bytes());
  }
}

}  // namespace mien::app
