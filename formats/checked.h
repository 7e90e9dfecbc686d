// Overflow-checked arithmetic on numbers from a file. An overflow makes all further results
// invalid.
#pragma once

#include <cstdint>

namespace mien::formats {

class Checked {
 public:
  constexpr Checked(std::uint64_t value)
      : value_(value) {}  // NOLINT: implicit conversion is intended

  [[nodiscard]] constexpr bool valid() const { return valid_; }
  // The number, or 2^64 - 1 after an overflow, which exceeds every limit.
  [[nodiscard]] constexpr std::uint64_t value() const { return valid_ ? value_ : UINT64_MAX; }

  friend constexpr Checked operator+(Checked a, Checked b) {
    return make(a.value_ + b.value_, a.valid_ && b.valid_ && a.value_ <= UINT64_MAX - b.value_);
  }
  friend constexpr Checked operator*(Checked a, Checked b) {
    const bool fits = a.value_ == 0 || b.value_ <= UINT64_MAX / a.value_;
    return make(a.value_ * b.value_, a.valid_ && b.valid_ && fits);
  }
  // The next multiple of a power of two.
  [[nodiscard]] constexpr Checked aligned(std::uint64_t alignment) const {
    const Checked raised = *this + (alignment - 1);
    return make(raised.value_ & ~(alignment - 1), raised.valid_);
  }

 private:
  static constexpr Checked make(std::uint64_t value, bool valid) {
    Checked result(value);
    result.valid_ = valid;
    return result;
  }

  std::uint64_t value_;
  bool valid_ = true;
};

}  // namespace mien::formats
