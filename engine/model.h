// A validated weight file with consistent layer shapes. Owns no memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/shape.h"
#include "formats/mien_file.h"

namespace mien::engine {

class Model {
 public:
  Model() = default;

  // `bytes` must be formats::kFileAlignment-aligned and outlive the model unchanged. On error *this
  // is empty.
  [[nodiscard]] mien_error_detail open(std::span<const std::byte> bytes);

  // Describes later errors in *detail (may be nullptr) as those of the file with this index.
  void describe_errors(mien_error_detail* detail, std::int32_t file) {
    errors_ = detail;
    file_index_ = file;
  }
  // Describe an error of this file and return its status.
  mien_status fail(mien_status status, const char* field, std::string_view name) const;
  // Of a network, and of one of its layers unless `layer` is -1.
  mien_status fail(mien_status status, const formats::NetworkRecord& network,
                   std::int32_t layer = -1, const char* field = nullptr) const;
  // `field` of a network has another value than the expected one.
  [[nodiscard]] mien_status mismatch(const formats::NetworkRecord& network, const char* field,
                                     std::int32_t got, std::int32_t expected) const;
  // A constant has the value or size `got`, not one from `min` to `max`.
  [[nodiscard]] mien_status bad_constant(mien_status status, std::string_view name, double got,
                                         double min, double max) const;

  [[nodiscard]] const formats::FileView& file() const { return file_; }
  // nullptr if the file has no network with that name.
  [[nodiscard]] const formats::NetworkRecord* network(std::string_view name) const {
    return file_.find_network(name);
  }
  // Finds an fp32 constant with exactly `elems` elements.
  // Returns MIEN_ERROR_WEIGHTS_INCOMPLETE or MIEN_ERROR_WEIGHTS_SHAPE otherwise.
  [[nodiscard]] mien_status constant(std::string_view name, std::size_t elems,
                                     std::span<const float>& values) const;

 private:
  // Where an error is described, if at all.
  [[nodiscard]] mien_error_detail* described(mien_status status, const char* field) const;
  mien_error_detail* described(mien_status status, const formats::NetworkRecord& network,
                               std::int32_t layer, const char* field) const;

  formats::FileView file_;
  mien_error_detail* errors_ = nullptr;
  std::int32_t file_index_ = -1;
};

[[nodiscard]] Shape input_shape(const formats::NetworkRecord& network);

// Infers the shapes of a network's layers in order, for a given input.
class ShapeWalk {
 public:
  ShapeWalk(std::span<const formats::LayerRecord> layers, const Shape& input);

  // Advances to the next layer; returns false at the end or on a mismatch (see status).
  bool next();
  [[nodiscard]] mien_status status() const { return status_; }
  [[nodiscard]] std::uint32_t index() const { return index_; }  // current layer
  [[nodiscard]] const Shape& shape_of(std::uint32_t value) const { return shapes_[value]; }
  [[nodiscard]] const Shape& input() const;   // of the current layer
  [[nodiscard]] const Shape& second() const;  // second input; the first if the layer has one input
  [[nodiscard]] const Shape& output() const { return shapes_[index_ + 1]; }

 private:
  std::span<const formats::LayerRecord> layers_;
  mien_status status_ = MIEN_OK;
  std::uint32_t index_ = 0;
  bool begun_ = false;
  Shape shapes_[formats::kMaxLayers + 1];
};

[[nodiscard]] LayerCost network_cost(std::span<const formats::LayerRecord> layers,
                                     const Shape& input);

}  // namespace mien::engine
