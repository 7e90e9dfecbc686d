// How the axes of an array are a network's maps: [c] or, of maps larger than 1x1, [c][h][w] (or
// [h][w][c]) come last; axes in front of them count streams and, the last one, steps.
#pragma once

#include <mien/engine.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/networks/run.h"

namespace mien::app {

class ArrayShape {
 public:
  ArrayShape(std::span<const std::uint64_t> dims, const NetworkInfo& network, MapLayout layout);

  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] std::string mismatch() const;  // where it does not fit
  [[nodiscard]] const TensorShape& map() const { return map_; }
  [[nodiscard]] std::uint64_t steps() const;
  [[nodiscard]] std::uint64_t steps_of_a_stream() const;
  // Of the array of an output: the same axes in front.
  [[nodiscard]] std::vector<std::uint64_t> output(const TensorShape& map) const;

 private:
  bool take(const std::vector<std::uint64_t>& item);
  [[nodiscard]] std::vector<std::uint64_t> axes(const TensorShape& map) const;
  bool take_larger(const TensorShape& declared);

  std::vector<std::uint64_t> dims_;
  std::vector<std::uint64_t> front_;
  TensorShape map_;
  MapLayout layout_;
  std::string wanted_;
  bool without_rows_ = false;  // a map of one row came as [c][w]
  bool fits_ = false;
};

}  // namespace mien::app
