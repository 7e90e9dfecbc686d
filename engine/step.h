// A step of a session: one kernel and its arguments.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/plan.h"
#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::engine {

struct Step {
  static constexpr std::size_t kArgsBytes = sizeof(kernels::InvertedResidualArgs);  // the largest
  kernels::AnyKernel kernel;
  void (*call)(const Step&);               // casts kernel and args to their types
  std::uint32_t first_layer, layer_count;  // layers that the step computes
  alignas(8) std::byte args[kArgsBytes];
};

// Creates steps from layers, after the plan has placed the maps.
class StepMaker {
 public:
  // `maps`: one pointer per value, nullptr if no step accesses it. `scratch`: at
  // Plan::scratch_offset.
  StepMaker(const Plan& plan, const formats::FileView& file, std::uint32_t cpu_mask,
            float* const* maps, float* scratch)
      : plan_(plan), file_(file), cpu_mask_(cpu_mask), maps_(maps), scratch_(scratch) {}

  // Memory of one step: Plan::state_elems floats and Plan::weights_bytes bytes.
  struct Memory {
    float* state;
    std::byte* weights;
  };

  // Returns kNoKernel if no allowed tier has a kernel.
  [[nodiscard]] mien_status make(std::uint32_t layer, const Memory& own, Step& step) const;

 private:
  struct Map {
    Shape shape;
    float* data;
  };

  [[nodiscard]] Map map(std::uint32_t value) const {
    return {plan_.value(value).shape, maps_[value]};
  }
  [[nodiscard]] const std::uint16_t* halves(std::uint32_t tensor) const;
  [[nodiscard]] kernels::ActivationSpec activation(const formats::LayerRecord& layer) const;

  // Sets the fields common to all layers with weights and an activation; the rest is zero.
  template <class Args>
  [[nodiscard]] Args weighted(const formats::LayerRecord& layer, Map x, Map y) const;

  [[nodiscard]] kernels::Conv2dArgs conv2d(const formats::LayerRecord& layer, Map x, Map y) const;
  [[nodiscard]] kernels::DepthwiseArgs depthwise(const formats::LayerRecord& layer, Map x,
                                                 Map y) const;
  [[nodiscard]] kernels::InvertedResidualArgs block(std::uint32_t layer,
                                                    std::uint32_t depthwise_layer) const;
  [[nodiscard]] kernels::InvertedResidualArgs::Weights weights(std::uint32_t layer) const;
  [[nodiscard]] mien_status quantize_block(std::uint32_t layer, std::byte* to,
                                           kernels::InvertedResidualArgs& args) const;
  [[nodiscard]] kernels::PointwiseArgs pointwise(std::uint32_t layer, Map x, Map y) const;
  [[nodiscard]] kernels::FullyConnectedArgs fully_connected(const formats::LayerRecord& layer,
                                                            Map x, Map y) const;
  [[nodiscard]] kernels::CausalConvArgs causal_conv(const formats::LayerRecord& layer, Map x, Map y,
                                                    float* state) const;
  [[nodiscard]] kernels::LstmArgs lstm(const formats::LayerRecord& layer, Map x, Map y,
                                       float* state) const;
  [[nodiscard]] static kernels::MaxPoolArgs max_pool(const formats::LayerRecord& layer, Map x,
                                                     Map y);
  [[nodiscard]] kernels::ResidualAddArgs add(const formats::LayerRecord& layer, Map x, Map y) const;

  [[nodiscard]] kernels::CombineArgs combine(kernels::Combination kind,
                                             const formats::LayerRecord& layer, Map x, Map y) const;
  [[nodiscard]] kernels::ConcatArgs concat(const formats::LayerRecord& layer, Map x, Map y) const;
  [[nodiscard]] static kernels::SliceArgs slice(const formats::LayerRecord& layer, Map x, Map y);

  template <class Args>
  [[nodiscard]] mien_status put(const Args& args, Step& step) const;
  [[nodiscard]] mien_status put_activation(const formats::LayerRecord& l, Map x, Map y,
                                           Step& step) const;
  [[nodiscard]] mien_status put_block(std::uint32_t layer, std::uint32_t depthwise_layer,
                                      const Memory& own, Step& step) const;

  const Plan& plan_;
  const formats::FileView& file_;
  std::uint32_t cpu_mask_;
  float* const* maps_;
  float* scratch_;
};

}  // namespace mien::engine
