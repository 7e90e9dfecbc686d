// Opens weight files and validates the shapes of their networks.
#include "engine/model.h"

namespace mien::engine {

using formats::LayerRecord;
using formats::NetworkRecord;

const char* message(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kBadFile:
      return "the weight file violates its format";
    case Status::kNoSuchNetwork:
      return "the weight file has no network or constant with that name and size";
    case Status::kShapeMismatch:
      return "a layer's declared output shape does not match its input";
    case Status::kWrongInput:
      return "the network does not accept an input of that shape";
    case Status::kUnsupportedLayout:
      return "a layer other than a convolution reads the interleaved image";
    case Status::kNoKernel:
      return "no allowed tier has a kernel for a layer";
    case Status::kMemoryTooSmall:
      return "the caller's memory is too small";
    case Status::kMisaligned:
      return "the caller's memory is not aligned";
    case Status::kTooLarge:
      return "the network's maps are too large for an input of that shape";
    case Status::kOutOfMemory:
      return "out of memory";
  }
  return "unknown status";
}

Shape input_shape(const NetworkRecord& network) {
  return {static_cast<std::int32_t>(network.input_height),
          static_cast<std::int32_t>(network.input_width),
          static_cast<std::int32_t>(network.input_channels)};
}

ShapeWalk::ShapeWalk(std::span<const LayerRecord> layers, const Shape& input) : layers_(layers) {
  shapes_[0] = input;
}

const Shape& ShapeWalk::input() const { return shapes_[layers_[index_].input]; }

const Shape& ShapeWalk::second() const {
  const std::uint32_t value = layers_[index_].second_input;
  return value == formats::kNoIndex ? input() : shapes_[value];
}

bool ShapeWalk::next() {
  const std::uint32_t following = begun_ ? index_ + 1 : 0;
  if (status_ != Status::kOk || following >= layers_.size()) {
    return false;
  }
  begun_ = true;
  index_ = following;
  status_ = infer_shape(layers_[index_], input(), second(), shapes_[index_ + 1]);
  return status_ == Status::kOk;
}

LayerCost network_cost(std::span<const LayerRecord> layers, const Shape& input) {
  LayerCost total;
  ShapeWalk walk(layers, input);
  while (walk.next()) {
    const LayerCost one = layer_cost(layers[walk.index()], walk.input(), walk.output());
    total.parameters += one.parameters;
    total.macs += one.macs;
  }
  return total;
}

namespace {

Status check_declared_shapes(std::span<const LayerRecord> layers, const Shape& input) {
  ShapeWalk walk(layers, input);
  while (walk.next()) {
    const LayerRecord& layer = layers[walk.index()];
    const Shape declared{static_cast<std::int32_t>(layer.height),
                         static_cast<std::int32_t>(layer.width),
                         static_cast<std::int32_t>(layer.channels)};
    if (walk.output() != declared) {
      return Status::kShapeMismatch;
    }
  }
  return walk.status();
}

}  // namespace

Status Model::open(std::span<const std::byte> bytes, formats::Validation* fault) {
  file_ = {};
  formats::FileView file;
  const formats::Validation validation = formats::open(bytes, file);
  if (fault != nullptr) {
    *fault = validation;
  }
  if (validation.status != formats::FileStatus::kOk) {
    return Status::kBadFile;
  }
  for (const NetworkRecord& network : file.networks()) {
    const Status status = check_declared_shapes(file.layers(network), input_shape(network));
    if (status != Status::kOk) {
      return status;
    }
  }
  file_ = file;
  return Status::kOk;
}

Status Model::constant(std::string_view name, std::size_t elems,
                       std::span<const float>& values) const {
  const formats::TensorRecord* tensor = file_.find_constant(name);
  if (tensor == nullptr || tensor->bytes != elems * sizeof(float) ||
      tensor->type != static_cast<std::uint16_t>(formats::DataType::kFloat32)) {
    return Status::kNoSuchNetwork;
  }
  values = {reinterpret_cast<const float*>(file_.data(*tensor).data()), elems};
  return Status::kOk;
}

}  // namespace mien::engine
