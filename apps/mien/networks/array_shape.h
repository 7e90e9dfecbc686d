// Matches the axes of an array with the input of a network. The last axes are one input: [c] for a
// vector, [c][h][w] or [h][w][c] for a map. Of the axes before them, the last counts time steps and
// the others count streams.
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
  [[nodiscard]] std::string mismatch() const;  // the error message if the array does not fit
  [[nodiscard]] const TensorShape& map() const { return map_; }
  [[nodiscard]] std::uint64_t steps() const;
  [[nodiscard]] std::uint64_t steps_per_stream() const;
  // The shape of the array of an output: it has the same axes before the map.
  [[nodiscard]] std::vector<std::uint64_t> output(const TensorShape& map) const;

 private:
  bool take(const std::vector<std::uint64_t>& item);
  [[nodiscard]] std::vector<std::uint64_t> axes(const TensorShape& map) const;
  bool take_larger(const TensorShape& declared);

  std::vector<std::uint64_t> dims_;
  std::vector<std::uint64_t> front_;
  TensorShape map_;
  MapLayout layout_;
  std::string expected_;
  bool single_row_ = false;  // a map with one row, given as [c][w]
  bool fits_ = false;
};

}  // namespace mien::app
