/// @file
/// C++20 wrapper of the C API for custom networks and for the content of weight files: header only,
/// no exceptions. mien.h documents the layout of maps, the state of temporal layers, units and
/// statuses. mien_convert converts ONNX files (docs/convert.md).
///
///     const mien::LoadedWeights loaded = mien::load_weights("model.mien");
///     mien::Network network;
///     if (network.create(mien::NetworkConfig(loaded.weights, "encoder")) != MIEN_OK) return;
///     for (const std::span<const float> image : images) {
///       std::copy(image.begin(), image.end(), network.input().begin());
///       network.run();
///       use(network.output(0));  // std::span<const float>
///     }
#pragma once

#include <mien/mien.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace mien {

/// Shape of a map: rows, columns, channels.
struct TensorShape : mien_shape {
  constexpr TensorShape(std::int32_t rows = 0, std::int32_t columns = 0, std::int32_t depth = 0)
      : mien_shape{rows, columns, depth} {}
  constexpr TensorShape(const mien_shape& shape) : mien_shape(shape) {}  // NOLINT: a conversion
  friend constexpr bool operator==(const TensorShape& a, const TensorShape& b) {
    return a.height == b.height && a.width == b.width && a.channels == b.channels;
  }
};

/// Size of a map in the layout of mien_network.
/// @param shape     rows, columns, channels
/// @param is_input  whether it is the input of a network, which may be interleaved
/// @return number of floats, unused lanes included
[[nodiscard]] inline std::size_t map_elements(const mien_shape& shape, bool is_input) {
  const auto pixels =
      static_cast<std::size_t>(shape.height) * static_cast<std::size_t>(shape.width);
  const auto channels = static_cast<std::size_t>(shape.channels);
  const bool interleaved = is_input && channels <= 4 && pixels > 1;
  return pixels * (interleaved ? channels : (channels + 7) / 8 * 8);
}

namespace detail {
/// For statuses that cannot be errors, or whose error shows in the result.
inline void ignore(mien_status) {}
}  // namespace detail

/// A configuration, initialized by mien_network_config_default.
struct NetworkConfig : mien_network_config {
  /// @param shared  must not be empty; need not outlive the networks
  /// @param network  name, which must outlive the configuration; nullptr: the first
  explicit NetworkConfig(const Weights& shared, const char* network = nullptr)
      : mien_network_config() {
    mien_network_config_default(this);
    weights = shared.get();
    name = network;
  }
};

/// Owns a mien_network. Empty until `create` or `create_in` succeeds.
class Network {
 public:
  /// See mien_network_create. An error leaves *this unchanged.
  [[nodiscard]] mien_status create(const mien_network_config& config,
                                   mien_error_detail* error = nullptr) {
    mien_network* created = nullptr;
    const mien_status status = mien_network_create(&config, &created, error);
    return take_over(status, created);
  }

  /// See mien_network_create_in. An error leaves *this unchanged.
  [[nodiscard]] mien_status create_in(const mien_network_config& config,
                                      std::span<std::byte> memory,
                                      mien_error_detail* error = nullptr) {
    mien_network* created = nullptr;
    const mien_status status =
        mien_network_create_in(&config, memory.data(), memory.size(), &created, error);
    return take_over(status, created);
  }

  /// @name After create
  /// @{
  /// See mien_network_input.
  [[nodiscard]] TensorShape input_shape() const {
    mien_shape shape = {};
    mien_network_input(network_.get(), &shape);
    return shape;
  }
  /// See mien_network_input.
  /// @return [map_elements(input_shape(), true)]
  [[nodiscard]] std::span<float> input() {
    mien_shape shape = {};
    float* values = mien_network_input(network_.get(), &shape);
    return {values, map_elements(shape, true)};
  }
  /// See mien_network_run.
  void run() { detail::ignore(mien_network_run(network_.get())); }
  /// See mien_network_output_count.
  [[nodiscard]] std::int32_t output_count() const {
    return mien_network_output_count(network_.get());
  }
  /// See mien_network_output.
  [[nodiscard]] TensorShape output_shape(std::int32_t index) const {
    mien_shape shape = {};
    mien_network_output(network_.get(), index, &shape);
    return shape;
  }
  /// See mien_network_output.
  /// @return [map_elements(output_shape(index), false)]
  [[nodiscard]] std::span<const float> output(std::int32_t index) const {
    mien_shape shape = {};
    const float* values = mien_network_output(network_.get(), index, &shape);
    return {values, map_elements(shape, false)};
  }
  /// See mien_network_reset.
  void reset() { mien_network_reset(network_.get()); }
  /// See mien_network_step_count.
  [[nodiscard]] std::int32_t step_count() const { return mien_network_step_count(network_.get()); }
  /// The layers first .. first + count - 1 of a network, from 0.
  struct StepLayers {
    std::int32_t first = 0, count = 0;
  };
  /// See mien_network_step_layers.
  [[nodiscard]] StepLayers step_layers(std::int32_t step) const {
    StepLayers layers;
    layers.count = mien_network_step_layers(network_.get(), step, &layers.first);
    return layers;
  }
  /// See mien_network_run_step.
  void run_step(std::int32_t step) { detail::ignore(mien_network_run_step(network_.get(), step)); }
  /// @}

  explicit operator bool() const { return network_ != nullptr; }
  /// @return nullptr if empty
  [[nodiscard]] mien_network* get() const { return network_.get(); }

 private:
  struct Destroy {
    void operator()(mien_network* network) const { mien_network_destroy(network); }
  };

  [[nodiscard]] mien_status take_over(mien_status status, mien_network* created) {
    if (status == MIEN_OK) {
      network_.reset(created);
    }
    return status;
  }

  std::unique_ptr<mien_network, Destroy> network_;
};

/// See mien_network_required_bytes.
/// @param config  configuration
/// @param status  receives MIEN_OK or the error
/// @return size in bytes of the memory for Network::create_in; 0 on error
[[nodiscard]] inline std::size_t required_bytes(const mien_network_config& config,
                                                mien_status& status) {
  std::size_t bytes = 0;
  status = mien_network_required_bytes(&config, &bytes, nullptr);
  return bytes;
}

/// A network of weights.
struct NetworkInfo : mien_network_info {
  NetworkInfo() : mien_network_info() { struct_size = sizeof(mien_network_info); }
};

/// A layer of a network.
struct LayerInfo : mien_layer_info {
  LayerInfo() : mien_layer_info() { struct_size = sizeof(mien_layer_info); }
};

/// A key and its value.
struct MetadataInfo : mien_metadata_info {
  MetadataInfo() : mien_metadata_info() { struct_size = sizeof(mien_metadata_info); }
  /// @return the value, UTF-8
  [[nodiscard]] std::string_view text() const { return {value, value_bytes}; }
};

/// A named constant.
struct ConstantInfo : mien_constant_info {
  ConstantInfo() : mien_constant_info() { struct_size = sizeof(mien_constant_info); }
};

/// The content of weights, which must outlive this object: see mien_weights_network, _layer,
/// _metadata and _constant. Indices outside their range give empty infos.
class WeightsContent {
 public:
  explicit WeightsContent(const Weights& weights) : weights_(weights.get()) {}

  [[nodiscard]] std::int32_t network_count() const { return mien_weights_network_count(weights_); }
  [[nodiscard]] NetworkInfo network(std::int32_t index) const {
    NetworkInfo info;
    detail::ignore(mien_weights_network(weights_, index, &info));
    return info;
  }
  [[nodiscard]] LayerInfo layer(std::int32_t network, std::int32_t index) const {
    LayerInfo info;
    detail::ignore(mien_weights_layer(weights_, network, index, &info));
    return info;
  }
  [[nodiscard]] std::int32_t metadata_count() const {
    return mien_weights_metadata_count(weights_);
  }
  [[nodiscard]] MetadataInfo metadata(std::int32_t index) const {
    MetadataInfo info;
    detail::ignore(mien_weights_metadata(weights_, index, &info));
    return info;
  }
  [[nodiscard]] std::int32_t constant_count() const {
    return mien_weights_constant_count(weights_);
  }
  [[nodiscard]] ConstantInfo constant(std::int32_t index) const {
    ConstantInfo info;
    detail::ignore(mien_weights_constant(weights_, index, &info));
    return info;
  }

 private:
  const mien_weights* weights_;
};

}  // namespace mien
