// A validated weight file with consistent layer shapes. Owns no memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/shape.h"
#include "engine/status.h"
#include "formats/mien_file.h"

namespace mien::engine {

class Model {
 public:
  Model() = default;

  // `bytes` must outlive the model unchanged. On kBadFile, `fault` (may be nullptr) receives the
  // violated rule and its offset. On error *this is empty.
  Status open(std::span<const std::byte> bytes, formats::Validation* fault = nullptr);

  [[nodiscard]] const formats::FileView& file() const { return file_; }
  // nullptr if the file has no network with that name.
  [[nodiscard]] const formats::NetworkRecord* network(std::string_view name) const {
    return file_.find_network(name);
  }
  // Finds an fp32 constant with exactly `elems` elements.
  Status constant(std::string_view name, std::size_t elems, std::span<const float>& values) const;

 private:
  formats::FileView file_;
};

[[nodiscard]] Shape input_shape(const formats::NetworkRecord& network);

// Infers the shapes of a network's layers in order, for a given input.
class ShapeWalk {
 public:
  ShapeWalk(std::span<const formats::LayerRecord> layers, const Shape& input);

  // Advances to the next layer; returns false at the end or on a mismatch (see status).
  bool next();
  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] std::uint32_t index() const { return index_; }  // current layer
  [[nodiscard]] const Shape& shape_of(std::uint32_t value) const { return shapes_[value]; }
  [[nodiscard]] const Shape& input() const;   // of the current layer
  [[nodiscard]] const Shape& second() const;  // second input; the first if the layer has one input
  [[nodiscard]] const Shape& output() const { return shapes_[index_ + 1]; }

 private:
  std::span<const formats::LayerRecord> layers_;
  Status status_ = Status::kOk;
  std::uint32_t index_ = 0;
  bool begun_ = false;
  Shape shapes_[formats::kMaxLayers + 1];
};

[[nodiscard]] LayerCost network_cost(std::span<const formats::LayerRecord> layers,
                                     const Shape& input);

}  // namespace mien::engine
