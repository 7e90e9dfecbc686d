// Opens weight files and infers the shapes of their networks.
#include "engine/model.h"

namespace mien::engine {

using formats::LayerRecord;
using formats::NetworkRecord;

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
  if (status_ != MIEN_OK || following >= layers_.size()) {
    return false;
  }
  begun_ = true;
  index_ = following;
  status_ = infer_shape(layers_[index_], input(), second(), shapes_[index_ + 1]);
  return status_ == MIEN_OK;
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

void locate(mien_error_detail& detail, const formats::FileView& file, const NetworkRecord& network,
            std::int32_t layer) {
  detail.network = static_cast<std::int32_t>(&network - file.networks().data());
  detail.layer = layer;
  formats::set_name(detail, file.text(network.name));
}

}  // namespace

mien_error_detail Model::open(std::span<const std::byte> bytes) {
  file_ = {};
  return formats::open(bytes, file_);
}

mien_error_detail* Model::described(mien_status status, const char* field) const {
  if (errors_ != nullptr) {
    formats::describe(*errors_, status, field);
    errors_->file = file_index_;
  }
  return errors_;
}

mien_error_detail* Model::described(mien_status status, const NetworkRecord& network,
                                    std::int32_t layer, const char* field) const {
  mien_error_detail* detail = described(status, field);
  if (detail != nullptr) {
    locate(*detail, file_, network, layer);
  }
  return detail;
}

mien_status Model::fail(mien_status status, const char* field, std::string_view name) const {
  mien_error_detail* detail = described(status, field);
  if (detail != nullptr) {
    formats::set_name(*detail, name);
  }
  return status;
}

mien_status Model::fail(mien_status status, const NetworkRecord& network, std::int32_t layer,
                        const char* field) const {
  described(status, network, layer, field);
  return status;
}

mien_status Model::mismatch(const NetworkRecord& network, const char* field, std::int32_t got,
                            std::int32_t expected) const {
  mien_error_detail* detail = described(MIEN_ERROR_WEIGHTS_SHAPE, network, -1, field);
  if (detail != nullptr) {
    formats::set_got(*detail, got);
    formats::set_expected(*detail, expected, expected);
  }
  return MIEN_ERROR_WEIGHTS_SHAPE;
}

mien_status Model::bad_constant(mien_status status, std::string_view name, double got, double min,
                                double max) const {
  fail(status, "constant", name);
  if (errors_ != nullptr) {
    formats::set_got(*errors_, got);
    formats::set_expected(*errors_, min, max);
  }
  return status;
}

mien_status Model::constant(std::string_view name, std::size_t elems,
                            std::span<const float>& values) const {
  const formats::TensorRecord* tensor = file_.find_constant(name);
  if (tensor == nullptr) {
    return fail(MIEN_ERROR_WEIGHTS_INCOMPLETE, "constant", name);
  }
  if (tensor->type != static_cast<std::uint16_t>(formats::DataType::kFloat32)) {
    return fail(MIEN_ERROR_WEIGHTS_SHAPE, "constant", name);
  }
  if (tensor->bytes != elems * sizeof(float)) {
    const std::uint64_t stored = tensor->bytes / sizeof(float);
    const auto expected = static_cast<double>(elems);
    return bad_constant(MIEN_ERROR_WEIGHTS_SHAPE, name, static_cast<double>(stored), expected,
                        expected);
  }
  values = {reinterpret_cast<const float*>(file_.data(*tensor).data()), elems};
  return MIEN_OK;
}

}  // namespace mien::engine
