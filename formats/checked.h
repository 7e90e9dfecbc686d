// The one place where sizes from a file are added, multiplied and aligned.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace mien::formats {

// An unsigned number that remembers whether any step on the way to it wrapped around.
class Checked {
 public:
  constexpr Checked(std::uint64_t value) : value_(value) {}  // NOLINT: numbers convert on purpose

  constexpr bool ok() const { return ok_; }
  // True where the number is exact and not above `limit`: the only way to use it.
  constexpr bool at_most(std::uint64_t limit) const { return ok_ && value_ <= limit; }
  constexpr bool equals(std::uint64_t other) const { return ok_ && value_ == other; }
  // Meaningful only after ok(), at_most() or equals() said yes.
  constexpr std::uint64_t value() const { return value_; }

  friend constexpr Checked operator+(Checked a, Checked b) {
    return Checked(a.value_ + b.value_, a.ok_ && b.ok_ && a.value_ <= kMax - b.value_);
  }
  friend constexpr Checked operator*(Checked a, Checked b) {
    return Checked(a.value_ * b.value_,
                   a.ok_ && b.ok_ && (b.value_ == 0 || a.value_ <= kMax / b.value_));
  }
  // Rounds up to a multiple of a power of two.
  constexpr Checked aligned(std::uint64_t alignment) const {
    const Checked up = *this + (alignment - 1);
    return Checked(up.value_ & ~(alignment - 1), up.ok_ && std::has_single_bit(alignment));
  }

 private:
  static constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  constexpr Checked(std::uint64_t value, bool ok) : value_(value), ok_(ok) {}

  std::uint64_t value_;
  bool ok_ = true;
};

}  // namespace mien::formats
