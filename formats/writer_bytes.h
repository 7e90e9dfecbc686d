// Byte views and records for the writer of weight files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "formats/mien_format.h"
#include "formats/mien_layers.h"

namespace mien::formats {

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

inline std::uint64_t count_of(std::span<const std::uint32_t> shape) {
  std::uint64_t count = 1;
  for (const std::uint32_t dim : shape) {
    count *= dim;
  }
  return count;
}

inline TensorRecord tensor_record(DataType type, const TensorDims& dims) {
  TensorRecord record{};
  record.type = static_cast<std::uint16_t>(type);
  record.rank = static_cast<std::uint16_t>(dims.rank);
  std::transform(dims.dim, dims.dim + kMaxRank, record.dims,
                 [](std::uint64_t n) { return static_cast<std::uint32_t>(n); });
  return record;
}

}  // namespace mien::formats
