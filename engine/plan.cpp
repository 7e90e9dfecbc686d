// Infers shapes, fuses layers and places maps before a session is created.
#include "engine/plan.h"

#include "engine/arena_plan.h"
#include "formats/mien_layers.h"
#include "kernels/families.h"

namespace mien::engine {

using formats::kNoIndex;
using formats::LayerOp;
using formats::LayerRecord;

namespace {

bool accepts(const formats::NetworkRecord& network, const Shape& input) {
  const Shape declared = input_shape(network);
  const bool any_size = (network.flags & formats::kAnySize) != 0;
  return any_size ? input.c == declared.c && input.h >= declared.h && input.w >= declared.w
                  : input == declared;
}

// Names the first dimension that the network does not accept.
mien_status wrong_input(const Model& model, const formats::NetworkRecord& network,
                        const Shape& input) {
  const Shape declared = input_shape(network);
  if (input.c != declared.c) {
    return model.mismatch(network, "input channels", declared.c, input.c);
  }
  return input.h != declared.h ? model.mismatch(network, "input height", declared.h, input.h)
                               : model.mismatch(network, "input width", declared.w, input.w);
}

}  // namespace

mien_status Plan::make(const SessionRequest& request) {
  mien_status status = find_network(request);
  if (status != MIEN_OK) {
    return status;
  }
  status = infer(request.input == Shape{} ? input_shape(*network_) : request.input);
  if (status != MIEN_OK) {
    return status;
  }
  status = check_size();
  if (status != MIEN_OK) {
    return status;
  }
  fuse_additions();
  if (fuses_blocks(request.cpu_mask)) {
    fuse_blocks();
    uses_half_precision_ = uses_half_precision(request.cpu_mask);
    quantizes_weights_ = quantizes_weights(request.cpu_mask);
    has_int8_ = has_int8(request.cpu_mask);
  }
  place_maps();
  return MIEN_OK;
}

mien_status Plan::find_network(const SessionRequest& request) {
  model_ = request.model;
  network_ = model_->network(request.network);
  if (network_ == nullptr) {
    return model_->fail(MIEN_ERROR_WEIGHTS_INCOMPLETE, "network", request.network);
  }
  layers_ = model_->file().layers(*network_);
  return request.input == Shape{} || accepts(*network_, request.input)
             ? MIEN_OK
             : wrong_input(*model_, *network_, request.input);
}

mien_status Plan::infer(const Shape& input) {
  if (!is_allowed(input)) {
    return model_->fail(MIEN_ERROR_TOO_LARGE, *network_, -1, "input");
  }
  values_[0].shape = input;
  ShapeWalk walk(layers_, input);
  while (walk.next()) {
    const std::uint32_t i = walk.index();
    if (!is_allowed(walk.output())) {
      return fail(MIEN_ERROR_TOO_LARGE, i);
    }
    values_[i + 1].shape = walk.output();
    values_[i + 1].last_use = i;
    note_reads(i);
    const bool reads_image = layers_[i].input == 0 || layers_[i].second_input == 0;
    if (reads_image && input.interleaved() && op_of(layers_[i]) != LayerOp::kConv2d) {
      return fail(MIEN_ERROR_UNSUPPORTED_LAYOUT, i);
    }
  }
  for (std::uint32_t i = 0; i < output_count(); ++i) {
    values_[output(i)].is_output = true;
  }
  // The shapes are consistent for the declared input, so this input is the cause.
  return walk.status() == MIEN_OK ? MIEN_OK : fail(MIEN_ERROR_WEIGHTS_SHAPE, walk.index());
}

void Plan::note_reads(std::uint32_t layer) {
  for (const std::uint32_t value : {layers_[layer].input, layers_[layer].second_input}) {
    if (value != kNoIndex) {
      values_[value].last_use = layer;
      ++values_[value].readers;
    }
  }
}

// Ensures that sums of sizes do not overflow, including the session's other memory.
mien_status Plan::check_size() const {
  std::uint64_t elems = 0;
  for (std::uint32_t i = 0; i <= layer_count(); ++i) {
    // The maximum is an LSTM's: output, state and gates.
    elems += std::uint64_t{7} * blocked_elems(values_[i].shape);
  }
  return elems <= SIZE_MAX / 2 / sizeof(float)
             ? MIEN_OK
             : model_->fail(MIEN_ERROR_TOO_LARGE, *network_, -1, "input");
}

// A pointwise layer adds the residual itself if only the addition reads its output.
void Plan::fuse_additions() {
  step_count_ = layer_count();
  for (std::uint32_t i = 1; i < layer_count(); ++i) {
    const LayerRecord& sum = layers_[i];
    const bool adds_it = op_of(sum) == LayerOp::kAdd && sum.input == i;
    const bool alone = values_[i].readers == 1 && !values_[i].is_output;
    if (adds_it && alone && op_of(layers_[i - 1]) == LayerOp::kPointwise) {
      parts_[i] = Part::kAddition;
      --step_count_;
    }
  }
}

// Whether only the next layer, which must exist, reads this layer's output, and a fused block
// supports its activation.
bool Plan::has_single_fusable_consumer(std::uint32_t layer) const {
  const Value& value = values_[layer + 1];
  return layers_[layer + 1].input == layer + 1 && value.readers == 1 && !value.is_output &&
         fuses(layers_[layer]);
}

// Fuses each depthwise layer with the next pointwise layer and, if possible, the previous one.
void Plan::fuse_blocks() {
  for (std::uint32_t i = 0; i + 1 < layer_count(); ++i) {
    const bool is_windowed =
        op_of(layers_[i]) == LayerOp::kDepthwise && has_single_fusable_consumer(i);
    const LayerRecord& project = layers_[i + 1];
    const bool projects = op_of(project) == LayerOp::kPointwise && fuses(project);
    if (!is_windowed || !projects) {
      continue;
    }
    const bool expands = i > 0 && op_of(layers_[i - 1]) == LayerOp::kPointwise &&
                         parts_[i - 1] == Part::kStep && has_single_fusable_consumer(i - 1);
    parts_[i + 1] = Part::kInside;
    --step_count_;
    if (expands) {
      parts_[i] = Part::kInside;
      --step_count_;
    }
  }
}

std::uint32_t Plan::fused_addition(std::uint32_t layer) const {
  return layer + 1 < layer_count() && parts_[layer + 1] == Part::kAddition ? layer + 1 : kNoIndex;
}

std::uint32_t Plan::fused_depthwise(std::uint32_t layer) const {
  if (layer + 1 >= layer_count() || parts_[layer + 1] != Part::kInside) {
    return kNoIndex;
  }
  return op_of(layers_[layer]) == LayerOp::kDepthwise ? layer : layer + 1;
}

std::uint32_t Plan::step_layers(std::uint32_t layer) const {
  std::uint32_t end = layer + 1;
  while (end < layer_count() && is_fused_into_previous(end)) {
    ++end;
  }
  return end - layer;
}

std::size_t Plan::input_elems() const {
  const Shape& shape = values_[0].shape;
  return shape.interleaved() ? shape.pixels() * static_cast<std::size_t>(shape.c)
                             : blocked_elems(shape);
}

std::size_t Plan::state_elems(std::uint32_t layer) const {
  switch (op_of(layers_[layer])) {
    case LayerOp::kCausalConv:
      return blocked_elems(values_[layers_[layer].input].shape);
    case LayerOp::kLstm:
      return 2 * blocked_elems(values_[layer + 1].shape);
    default:
      return 0;
  }
}

// Longer sums are computed in fp32. Without an expand layer, x and hidden are the same value.
bool Plan::is_quantized(std::uint32_t layer, std::uint32_t depthwise_layer) const {
  const std::uint32_t x = layers_[layer].input, hidden = layers_[depthwise_layer].input;
  return (quantizes_weights_ || has_int8_) &&
         values_[x].shape.c <= kernels::kQuantizedWeightsMaxInputs &&
         values_[hidden].shape.c <= kernels::kQuantizedWeightsMaxInputs;
}

// Whether the block's input is copied to 16 bits per value before the expand layer.
bool Plan::has_half_input(std::uint32_t layer, std::uint32_t depthwise_layer) const {
  if (layer == depthwise_layer) {
    return false;
  }
  if (is_quantized(layer, depthwise_layer) && quantized_layer(layer).is_quantized) {
    return true;
  }
  const LayerRecord& depthwise = layers_[depthwise_layer];
  return uses_half_precision_ && !quantizes_weights_ &&
         kernels::has_short_half_sums(values_[layers_[layer].input].shape.c,
                                      depthwise.kernel_height, depthwise.kernel_width);
}

std::size_t Plan::weights_bytes(std::uint32_t layer) const {
  const std::uint32_t depthwise_layer = fused_depthwise(layer);
  if (is_fused_into_previous(layer) || depthwise_layer == kNoIndex ||
      !is_quantized(layer, depthwise_layer)) {
    return 0;
  }
  const std::size_t project = quantized_weights_bytes(quantized_layer(depthwise_layer + 1));
  return layer < depthwise_layer ? project + quantized_weights_bytes(quantized_layer(layer))
                                 : project;
}

QuantizedLayer Plan::quantized_layer(std::uint32_t layer) const {
  const LayerRecord& l = layers_[layer];
  const bool reads_map = parts_[layer] == Part::kStep;  // an expand layer begins its block
  const float bound = has_int8_ ? l.input_bound : 0.0f;
  return {values_[l.input].shape.c, values_[layer + 1].shape.c, quantizes_weights_ || bound > 0.0f,
          reads_map, bound};
}

std::size_t Plan::scratch_elems(std::uint32_t layer) const {
  if (op_of(layers_[layer]) == LayerOp::kLstm) {
    return 4 * blocked_elems(values_[layer + 1].shape);
  }
  const bool is_block = !is_fused_into_previous(layer) && fused_depthwise(layer) != kNoIndex;
  return is_block ? tiling(layer).scratch_elems() : 0;
}

BlockTiling Plan::tiling(std::uint32_t layer) const {
  const std::uint32_t depthwise_layer = fused_depthwise(layer);
  return tile_block(
      layers_[depthwise_layer], values_[layers_[depthwise_layer].input].shape,
      values_[depthwise_layer + 1].shape,
      has_half_input(layer, depthwise_layer) ? values_[layers_[layer].input].shape.c : 0);
}

std::size_t Plan::scratch_elems() const {
  std::size_t max = 0;
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    const std::size_t elems = scratch_elems(i);
    max = elems > max ? elems : max;
  }
  return max;
}

// Puts intermediate maps into the arena; input, outputs and state belong to the session.
void Plan::place_maps() {
  ArenaPlan arena;
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    state_elems_ += state_elems(i);
    weights_bytes_ += weights_bytes(i);
    Value& value = values_[i + step_layers(i)];
    if (is_fused_into_previous(i) || value.is_output) {
      continue;
    }
    const std::size_t bytes = blocked_elems(value.shape) * sizeof(float);
    value.in_arena = true;
    value.arena_offset = arena.place(bytes, i, value.last_use);
  }
  scratch_offset_ = arena.bytes();
  arena_bytes_ = scratch_offset_ + aligned(scratch_elems() * sizeof(float));
}

}  // namespace mien::engine
