// Properties of the bytes of a weight file: all zero, or all values finite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace mien::formats {

inline bool all_zero(std::span<const std::byte> bytes) {
  for (const std::byte one : bytes) {
    if (one != std::byte{0}) {
      return false;
    }
  }
  return true;
}

template <class Field>
bool is_zero(const Field& field) {
  return all_zero(std::as_bytes(std::span(&field, 1)));
}

// Infinities and NaNs have all bits of `exponent` set: adding its lowest bit carries into the sign
// only for these. Processes 64 bits at a time without early exit, because valid files are read to
// the end in any case.
template <class Word>
bool all_finite(std::span<const std::byte> data, Word exponent) {
  constexpr std::size_t kStep = sizeof(std::uint64_t);
  constexpr std::uint64_t kOfEach = ~std::uint64_t{0} / static_cast<Word>(~Word{0});
  const std::uint64_t exponents = kOfEach * exponent;
  const std::uint64_t lowest = kOfEach * static_cast<Word>(exponent & -exponent);
  std::uint64_t carried = 0;
  const auto check = [&](std::size_t at, std::size_t bytes) {
    std::uint64_t words = 0;
    std::memcpy(&words, data.data() + at, bytes);
    carried |= (words & exponents) + lowest;
  };
  std::size_t at = 0;
  for (; at + kStep <= data.size(); at += kStep) {
    check(at, kStep);
  }
  check(at, data.size() - at);
  return (carried & (exponents + lowest)) == 0;
}

}  // namespace mien::formats
