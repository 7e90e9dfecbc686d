// Plans a session before it has memory: the shape and lifetime of every value, the layers that run
// fused, and the places of intermediate maps in the arena.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/fused_block.h"
#include "engine/model.h"
#include "engine/quantized_weights.h"

namespace mien::engine {

struct SessionRequest {
  const Model* model = nullptr;  // the bytes of its file must outlive the session
  std::string_view network;
  Shape input;                          // all zero: the declared shape
  std::uint32_t cpu_mask = 0xFFFFFFFF;  // allowed tiers and kernels::kFusedBlocks
};

// Large: creating a session needs about 70 KB of stack.
class Plan {
 public:
  // Returns MIEN_ERROR_WEIGHTS_INCOMPLETE without the network, MIEN_ERROR_WEIGHTS_SHAPE if it does
  // not accept request.input, MIEN_ERROR_TOO_LARGE if a map exceeds formats::kMaxMapElems or all
  // maps exceed half of the address space; MIEN_ERROR_UNSUPPORTED_LAYOUT.
  [[nodiscard]] mien_status make(const SessionRequest& request);

  struct Value {
    Shape shape;
    std::uint32_t last_use = 0;  // index of the last layer that reads the value
    std::uint32_t readers = 0;
    bool is_output = false;
    bool in_arena = false;
    std::size_t arena_offset = 0;
  };

  // Describes an error in a layer.
  [[nodiscard]] mien_status fail(mien_status status, std::uint32_t layer) const {
    return model_->fail(status, *network_, static_cast<std::int32_t>(layer));
  }

  [[nodiscard]] std::uint32_t layer_count() const {
    return static_cast<std::uint32_t>(layers_.size());
  }
  [[nodiscard]] const formats::LayerRecord& layer(std::uint32_t i) const { return layers_[i]; }
  // Value 0 is the network's input, value k the output of the k-th layer.
  [[nodiscard]] const Value& value(std::uint32_t i) const { return values_[i]; }
  [[nodiscard]] std::uint32_t output_count() const { return network_->output_count; }
  [[nodiscard]] std::uint32_t output(std::uint32_t i) const {
    return formats::output_value(*network_, i);
  }

  // An earlier layer's step computes this layer.
  [[nodiscard]] bool is_fused_into_previous(std::uint32_t layer) const {
    return parts_[layer] != Part::kStep;
  }
  // The addition fused into this layer, as a layer index; kNoIndex without one.
  [[nodiscard]] std::uint32_t fused_addition(std::uint32_t layer) const;
  // The depthwise layer of the inverted residual block that begins with this layer, otherwise
  // kNoIndex. The next layer is the block's last.
  [[nodiscard]] std::uint32_t fused_depthwise(std::uint32_t layer) const;
  [[nodiscard]] BlockTiling tiling(std::uint32_t layer) const;
  // Number of layers of the step that begins with this layer.
  [[nodiscard]] std::uint32_t step_layers(std::uint32_t layer) const;
  [[nodiscard]] std::uint32_t step_count() const { return step_count_; }

  // Sizes in floats.
  [[nodiscard]] std::size_t input_elems() const;
  [[nodiscard]] std::size_t state_elems(std::uint32_t layer) const;
  [[nodiscard]] std::size_t state_elems() const { return state_elems_; }

  // A pointwise layer of a fused block with quantized weights.
  [[nodiscard]] QuantizedLayer quantized_layer(std::uint32_t layer) const;

  // Bytes of quantized weights of the step that begins with this layer, and of all steps.
  [[nodiscard]] std::size_t weights_bytes(std::uint32_t layer) const;
  [[nodiscard]] std::size_t weights_bytes() const { return weights_bytes_; }

  [[nodiscard]] std::size_t arena_bytes() const { return arena_bytes_; }
  // Scratch of the running step in the arena: an LSTM's gates, a fused block's bands.
  [[nodiscard]] std::size_t scratch_offset() const { return scratch_offset_; }

 private:
  [[nodiscard]] mien_status find_network(const SessionRequest& request);
  [[nodiscard]] mien_status infer(const Shape& input);
  void note_reads(std::uint32_t layer);
  [[nodiscard]] mien_status check_size() const;
  void fuse_additions();
  void fuse_blocks();
  [[nodiscard]] bool has_single_fusable_consumer(std::uint32_t layer) const;
  [[nodiscard]] bool is_quantized(std::uint32_t layer, std::uint32_t depthwise_layer) const;
  [[nodiscard]] bool has_half_input(std::uint32_t layer, std::uint32_t depthwise_layer) const;
  void place_maps();
  [[nodiscard]] std::size_t scratch_elems() const;
  [[nodiscard]] std::size_t scratch_elems(std::uint32_t layer) const;

  bool uses_half_precision_ = false;  // in fused blocks
  bool quantizes_weights_ = false;    // in fused blocks, up to kQuantizedWeightsMaxInputs
  bool has_int8_ = false;             // in fused blocks
  const Model* model_ = nullptr;
  const formats::NetworkRecord* network_ = nullptr;
  std::span<const formats::LayerRecord> layers_;
  Value values_[formats::kMaxLayers + 1];
  // A layer's part in a step: it begins one, is a fused addition, or is fused otherwise.
  enum class Part : std::uint8_t { kStep, kAddition, kInside };
  Part parts_[formats::kMaxLayers] = {};
  std::uint32_t step_count_ = 0;
  std::size_t state_elems_ = 0;
  std::size_t weights_bytes_ = 0;
  std::size_t scratch_offset_ = 0;
  std::size_t arena_bytes_ = 0;
};

}  // namespace mien::engine
