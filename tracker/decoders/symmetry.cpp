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

constexpr std::size_t named(std::string_view unit, std::string_view side) {
  std::size_t i = 0;
  while (!std::string_view(kControlNames[i]).starts_with(unit) ||
         std::string_view(kControlNames[i]).substr(unit.size()) != side) {
    ++i;
  }
  return i;
}

// Not jaw and mouth, which go to a side, nor eyes that look in and out, which they do together.
constexpr std::array<std::string_view, 16> kUnits = {
    "eyeBlink",   "eyeLookDown", "eyeLookUp",    "eyeSquint",  "eyeWide",        "mouthSmile",
    "mouthFrown", "mouthDimple", "mouthStretch", "mouthPress", "mouthLowerDown", "mouthUpperUp",
    "browDown",   "browOuterUp", "cheekSquint",  "noseSneer"};

constexpr std::array<Pair, kUnits.size()> kSides = [] {
  std::array<Pair, kUnits.size()> pairs{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {named(kUnits[i], "Left"), named(kUnits[i], "Right")};
  }
  return pairs;
}();

}  // namespace

void symmetrize(std::uint64_t supported, std::span<float, kControls> controls) {
  for (const Pair& pair : kSides) {
    const bool driven = (supported >> pair.left & supported >> pair.right & 1u) != 0;
    float& left = controls[pair.left];
    float& right = controls[pair.right];
    const float apart = left - right;
    if (driven && std::abs(apart) < kSymmetryThreshold) {
      const float step =
          apart * (1 - std::abs(apart) / kSymmetryThreshold) / 2;  // stays between both
      left -= step;
      right += step;
    }
  }
}

}  // namespace mien::tracker
