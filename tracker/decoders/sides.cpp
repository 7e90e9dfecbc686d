#include "tracker/decoders/sides.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace mien::tracker {
namespace {

struct Pair {
  std::size_t left;
  std::size_t right;
};

// Eyes look sideways together, one of them in and the other out; jaw and mouth have no sides, they
// go there.
constexpr bool has_sides(std::string_view unit) {
  return unit != "jaw" && unit != "mouth" && unit != "eyeLookIn" && unit != "eyeLookOut";
}

constexpr std::array<Pair, 16> kSides = [] {
  constexpr std::string_view kLeft = "Left";
  constexpr std::string_view kRight = "Right";
  std::array<Pair, 16> pairs{};
  std::size_t count = 0;
  for (std::size_t l = 0; l < kControls; ++l) {
    std::string_view unit = kControlNames[l];
    if (!unit.ends_with(kLeft)) {
      continue;
    }
    unit.remove_suffix(kLeft.size());
    for (std::size_t r = 0; r < kControls && has_sides(unit); ++r) {
      const std::string_view other = kControlNames[r];
      if (other.starts_with(unit) && other.substr(unit.size()) == kRight) {
        pairs[count++] = {l, r};
      }
    }
  }
  return pairs;
}();
static_assert(kSides.back().right != 0, "there are fewer pairs");

}  // namespace

void even_out_sides(std::uint64_t supported, std::span<float, kControls> controls) {
  for (const Pair& pair : kSides) {
    const bool driven = (supported >> pair.left & supported >> pair.right & 1u) != 0;
    float& left = controls[pair.left];
    float& right = controls[pair.right];
    const float apart = left - right;
    if (driven && std::abs(apart) < kToldApart) {
      const float middle = (left + right) / 2;
      const float half = apart * std::abs(apart) / kToldApart / 2;
      left = middle + half;
      right = middle - half;
    }
  }
}

}  // namespace mien::tracker
