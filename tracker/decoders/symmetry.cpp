// Symmetrizes pairs of controls.
#include "tracker/decoders/symmetry.h"

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

constexpr std::size_t control_of(std::string_view unit, std::string_view side) {
  std::size_t i = 0;
  while (!std::string_view(kControlNames[i]).starts_with(unit) ||
         std::string_view(kControlNames[i]).substr(unit.size()) != side) {
    ++i;
  }
  return i;
}

// Excluded: directions of jaw and mouth, whose sides are independent movements, and eyeLookIn and
// eyeLookOut, because both eyes look to the same side.
constexpr std::array<std::string_view, 16> kUnits = {
    "eyeBlink",   "eyeLookDown", "eyeLookUp",    "eyeSquint",  "eyeWide",        "mouthSmile",
    "mouthFrown", "mouthDimple", "mouthStretch", "mouthPress", "mouthLowerDown", "mouthUpperUp",
    "browDown",   "browOuterUp", "cheekSquint",  "noseSneer"};

constexpr std::array<Pair, kUnits.size()> kPairs = [] {
  std::array<Pair, kUnits.size()> pairs{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {control_of(kUnits[i], "Left"), control_of(kUnits[i], "Right")};
  }
  return pairs;
}();

}  // namespace

void symmetrize(std::uint64_t supported, std::span<float, kControls> controls) {
  for (const Pair& pair : kPairs) {
    const bool both = (supported >> pair.left & supported >> pair.right & 1u) != 0;
    float& left = controls[pair.left];
    float& right = controls[pair.right];
    const float difference = left - right;
    if (both && std::abs(difference) < kSymmetryThreshold) {
      // At most half of the difference, so that left and right do not swap.
      const float step = difference * (1 - std::abs(difference) / kSymmetryThreshold) / 2;
      left -= step;
      right += step;
    }
  }
}

}  // namespace mien::tracker
