// Converts the input of a target to numbers in ranges, so that every input is valid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace mien::fuzz {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  [[nodiscard]] bool empty() const { return left_.empty(); }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return left_; }

  // Up to `max` of the next bytes, without consuming them.
  [[nodiscard]] std::string_view text(std::int32_t max) const {
    return {reinterpret_cast<const char*>(left_.data()),
            std::min(left_.size(), static_cast<std::size_t>(max))};
  }

  // Zeros if no bytes are left.
  template <class T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof value, left_.size());
    if (count > 0) {
      std::memcpy(&value, left_.data(), count);
    }
    left_ = left_.subspan(count);
    return value;
  }

  // low..high, from one byte, or two if the range is larger than 256.
  std::int32_t between(std::int32_t low, std::int32_t high) {
    const auto range = static_cast<std::uint32_t>(high) - static_cast<std::uint32_t>(low) + 1;
    const std::uint32_t number = range <= 256 ? take<std::uint8_t>() : take<std::uint16_t>();
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(low) + number % range);
  }
  bool coin() { return between(0, 1) == 1; }

  template <class T, std::size_t n>
  T one_of(const T (&choices)[n]) {
    return choices[between(0, static_cast<std::int32_t>(n) - 1)];
  }

  // Any number; in half of the cases a boundary value: 0, 1, -1, limits, powers of two and their
  // neighbours.
  std::int32_t any_int() {
    constexpr std::int32_t kNumbers[] = {0,       1,       -1,          2,          3,     16,
                                         255,     4096,    16384,       16385,      32767, 65536,
                                         1 << 24, 1 << 30, -2147483647, 2147483647, -16};
    return coin() ? one_of(kNumbers) : take<std::int32_t>();
  }

 private:
  std::span<const std::uint8_t> left_;
};

// Stops the program unless the condition holds; a fuzzer then stores the input.
inline void require(bool condition) {
  if (!condition) {
    __builtin_trap();
  }
}

}  // namespace mien::fuzz
