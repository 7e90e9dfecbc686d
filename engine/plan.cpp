#include "engine/plan.h"

#include "engine/arena_plan.h"

namespace mien::engine {

using formats::kNoIndex;
using formats::LayerOp;
using formats::LayerRecord;

namespace {

LayerOp op_of(const LayerRecord& layer) { return static_cast<LayerOp>(layer.op); }

bool accepts(const formats::NetworkRecord& network, const Shape& input) {
  const Shape declared = input_shape(network);
  const bool any_size = (network.flags & formats::kAnySize) != 0;
  return any_size ? input.c == declared.c && input.h >= declared.h && input.w >= declared.w
                  : input == declared;
}

}  // namespace

Status Plan::make(const SessionRequest& request) {
  Status status = find_network(request);
  if (status != Status::kOk) {
    return status;
  }
  status = infer(request.input == Shape{} ? input_shape(*network_) : request.input);
  if (status != Status::kOk) {
    return status;
  }
  status = check_size();
  if (status != Status::kOk) {
    return status;
  }
  fuse_additions();
  place_maps();
  return Status::kOk;
}

Status Plan::find_network(const SessionRequest& request) {
  network_ = request.model->network(request.network);
  if (network_ == nullptr) {
    return Status::kNoSuchNetwork;
  }
  layers_ = request.model->file().layers(*network_);
  return request.input == Shape{} || accepts(*network_, request.input) ? Status::kOk
                                                                       : Status::kWrongInput;
}

Status Plan::infer(const Shape& input) {
  if (!is_allowed(input)) {
    return Status::kTooLarge;
  }
  values_[0].shape = input;
  ShapeWalk walk(layers_, input);
  while (walk.next()) {
    const std::uint32_t i = walk.index();
    if (!is_allowed(walk.output())) {
      return Status::kTooLarge;
    }
    values_[i + 1].shape = walk.output();
    values_[i + 1].last_use = i;
    note_reads(i);
    const bool reads_image = layers_[i].input == 0 || layers_[i].second_input == 0;
    if (reads_image && input.interleaved() && op_of(layers_[i]) != LayerOp::kConv2d) {
      return Status::kUnsupportedLayout;
    }
  }
  for (const std::uint32_t value : outputs()) {
    values_[value].is_output = true;
  }
  // The layers fit together at the declared size; at this one they do not.
  return walk.status() == Status::kOk ? Status::kOk : Status::kWrongInput;
}

void Plan::note_reads(std::uint32_t layer) {
  for (const std::uint32_t value : {layers_[layer].input, layers_[layer].second_input}) {
    if (value != kNoIndex) {
      values_[value].last_use = layer;
      ++values_[value].readers;
    }
  }
}

// Sums of sizes that pass cannot overflow, whatever else a session holds.
Status Plan::check_size() const {
  std::uint64_t elems = 0;
  for (std::uint32_t i = 0; i <= layer_count(); ++i) {
    // At most what an LSTM takes: its output, its state and its gates.
    elems += std::uint64_t{7} * blocked_elems(values_[i].shape);
  }
  return elems <= SIZE_MAX / 2 / sizeof(float) ? Status::kOk : Status::kTooLarge;
}

// A pointwise layer adds the residual itself when nothing else looks at its result.
void Plan::fuse_additions() {
  step_count_ = layer_count();
  for (std::uint32_t i = 1; i < layer_count(); ++i) {
    const LayerRecord& sum = layers_[i];
    const bool adds_it = op_of(sum) == LayerOp::kAdd && sum.input == i && sum.second_input != i;
    const bool alone = values_[i].readers == 1 && !values_[i].is_output;
    if (adds_it && alone && op_of(layers_[i - 1]) == LayerOp::kPointwise) {
      vanishes_[i] = true;
      --step_count_;
    }
  }
}

std::uint32_t Plan::fused_addition(std::uint32_t layer) const {
  return layer + 1 < layer_count() && vanishes_[layer + 1] ? layer + 1 : kNoIndex;
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

std::size_t Plan::scratch_elems() const {
  std::size_t most = 0;
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    const std::size_t gates = 4 * blocked_elems(values_[i + 1].shape);
    most = op_of(layers_[i]) == LayerOp::kLstm && gates > most ? gates : most;
  }
  return most;
}

// Maps in between go to the arena; input, outputs and state stay with the session.
void Plan::place_maps() {
  ArenaPlan arena;
  for (std::uint32_t i = 0; i < layer_count(); ++i) {
    state_elems_ += state_elems(i);
    const std::uint32_t sum = fused_addition(i);
    Value& value = values_[(sum == kNoIndex ? i : sum) + 1];
    if (vanishes_[i] || value.is_output) {
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
