// What a session needs to know before it has memory: every value's shape and lifetime, which layers
// run together, and where the maps in between lie in the arena.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/fused_block.h"
#include "engine/model.h"

namespace mien::engine {

struct SessionRequest {
  const Model* model = nullptr;  // its bytes must outlive the session
  std::string_view network;
  Shape input;                          // all zero: as the file declares it
  std::uint32_t cpu_mask = 0xFFFFFFFF;  // tiers that may be used, and kernels::kFusedBlocks
};

// Large: a thread that makes sessions needs some 70 KB of stack.
class Plan {
 public:
  // kWrongInput when the network does not run on request.input, kTooLarge when a map would exceed
  // formats::kMaxMapElems or all of them half of the address space.
  Status make(const SessionRequest& request);

  struct Value {
    Shape shape;
    std::uint32_t last_use = 0;  // layer
    std::uint32_t readers = 0;
    bool is_output = false;
    bool in_arena = false;
    std::size_t arena_offset = 0;
  };

  [[nodiscard]] std::uint32_t layer_count() const {
    return static_cast<std::uint32_t>(layers_.size());
  }
  [[nodiscard]] const formats::LayerRecord& layer(std::uint32_t i) const { return layers_[i]; }
  // 0 is the network's input, k the output of its k-th layer.
  [[nodiscard]] const Value& value(std::uint32_t i) const { return values_[i]; }
  [[nodiscard]] std::uint32_t output_count() const { return network_->output_count; }
  [[nodiscard]] std::uint32_t output(std::uint32_t i) const {
    return formats::output_value(*network_, i);
  }

  // A layer before performs this one too.
  [[nodiscard]] bool is_fused_into_previous(std::uint32_t layer) const {
    return parts_[layer] != Part::kStep;
  }
  // The addition that a layer performs besides, as a layer; kNoIndex if none.
  [[nodiscard]] std::uint32_t fused_addition(std::uint32_t layer) const;
  // The depthwise layer of the inverted residual block that begins with this layer; kNoIndex if
  // none. The block's last layer is the next.
  [[nodiscard]] std::uint32_t fused_depthwise(std::uint32_t layer) const;
  // How the block divides its work.
  [[nodiscard]] BlockTiling tiling(std::uint32_t layer) const;
  // Layers of the step that begins with this layer.
  [[nodiscard]] std::uint32_t step_layers(std::uint32_t layer) const;
  [[nodiscard]] std::uint32_t step_count() const { return step_count_; }

  // Floats.
  [[nodiscard]] std::size_t input_elems() const;
  [[nodiscard]] std::size_t state_elems(std::uint32_t layer) const;
  [[nodiscard]] std::size_t state_elems() const { return state_elems_; }

  // What the step that begins with this layer, and all steps, keep of weights in another form.
  [[nodiscard]] std::size_t weights_bytes(std::uint32_t layer) const;
  [[nodiscard]] std::size_t weights_bytes() const { return weights_bytes_; }

  [[nodiscard]] std::size_t arena_bytes() const { return arena_bytes_; }
  // In the arena, for the step that runs: an LSTM's gates, a fused block's bands.
  [[nodiscard]] std::size_t scratch_offset() const { return scratch_offset_; }

 private:
  Status find_network(const SessionRequest& request);
  Status infer(const Shape& input);
  void note_reads(std::uint32_t layer);
  [[nodiscard]] Status check_size() const;
  void fuse_additions();
  void fuse_blocks();
  [[nodiscard]] bool has_single_fusable_consumer(std::uint32_t layer) const;
  [[nodiscard]] bool is_quantized(std::uint32_t layer, std::uint32_t depthwise_layer) const;
  [[nodiscard]] bool has_half_input(std::uint32_t layer, std::uint32_t depthwise_layer) const;
  void place_maps();
  [[nodiscard]] std::size_t scratch_elems() const;
  [[nodiscard]] std::size_t scratch_elems(std::uint32_t layer) const;

  bool uses_half_precision_ = false;  // fused blocks are computed in half precision
  bool quantizes_weights_ = false;    // and their weights, unless they are too many, in fixed point
  const formats::NetworkRecord* network_ = nullptr;
  std::span<const formats::LayerRecord> layers_;
  Value values_[formats::kMaxLayers + 1];
  // Of a step: its beginning, an addition at its end, or what else is fused with those before.
  enum class Part : std::uint8_t { kStep, kAddition, kInside };
  Part parts_[formats::kMaxLayers] = {};
  std::uint32_t step_count_ = 0;
  std::size_t state_elems_ = 0;
  std::size_t weights_bytes_ = 0;
  std::size_t scratch_offset_ = 0;
  std::size_t arena_bytes_ = 0;
};

}  // namespace mien::engine
