// Random sizes, values and packed weights.
#include "apps/conformance/random_values.h"

#include <algorithm>
#include <cmath>

#include "formats/fp16.h"

namespace mien::conformance {

std::string_view name(Pattern pattern) {
  switch (pattern) {
    case Pattern::kMixed:
      return "mixed";
    case Pattern::kCancelling:
      return "cancelling";
    case Pattern::kDenormal:
      return "denormal";
    case Pattern::kHuge:
      return "huge";
    case Pattern::kSparse:
      return "sparse";
    case Pattern::kOrdinary:
      return "ordinary";
  }
  return "";
}

RandomValues::RandomValues(std::uint64_t seed, int case_number, const Arithmetic& arithmetic)
    : random_(seed * 1'000'003 + static_cast<std::uint64_t>(case_number)),
      case_number_(case_number),
      pattern_(static_cast<Pattern>(case_number % kPatternCount)),
      arithmetic_(arithmetic) {}

RandomValues::RandomValues(std::uint64_t seed, Pattern pattern)
    : random_(seed), case_number_(0), pattern_(pattern) {}

int RandomValues::between(int low, int high) {
  if (!choices_.empty()) {
    const int choice = choices_.front();
    choices_ = choices_.subspan(1);
    return low + choice % (high - low + 1);
  }
  return std::uniform_int_distribution<int>(low, high)(random_);
}

int RandomValues::size(int max) {
  constexpr int kTiles[] = {4, 6, 8, 12, 16, 24, 32, 48, 64};
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61};
  int size = between(1, max);
  switch (between(0, 3)) {
    case 0:
    case 1:
      size = kTiles[between(0, static_cast<int>(std::size(kTiles)) - 1)] * between(1, 3) +
             between(-1, 1);
      break;
    case 2:
      size = kPrimes[between(0, static_cast<int>(std::size(kPrimes)) - 1)];
      break;
    default:
      break;
  }
  return size <= max ? size : between(1, max);
}

// Pairs of values with nearly equal magnitude and opposite sign.
float RandomValues::cancelling() {
  const float step = static_cast<float>(between(0, 8));
  const float size = is_half() ? 64.0f + step * 0x1p-6f : 4096.0f + step * 0x1p-11f;
  return coin() ? size : -size;
}

float RandomValues::value() {
  const float ordinary = std::normal_distribution<float>()(random_);
  switch (pattern_) {
    case Pattern::kCancelling:
      return cancelling();
    case Pattern::kDenormal:
      return ordinary * (is_half() ? 0x1p-20f : 1e-39f);
    case Pattern::kHuge:
      return std::clamp(ordinary, -4.0f, 4.0f) * (is_half() ? 48.0f : 2.5e28f);
    case Pattern::kSparse:
      return between(0, 7) == 0 ? ordinary : (coin() ? 0.0f : -0.0f);
    case Pattern::kOrdinary:
      return ordinary;
    case Pattern::kMixed:
      break;
  }
  switch (between(0, 19)) {
    case 0:
      return 0.0f;
    case 1:
      return -0.0f;
    case 2:
      return ordinary * 1e-40f;
    case 3:
      return ordinary * (is_half() ? 1e2f : 1e4f);
    default:
      return ordinary;
  }
}

std::vector<float> RandomValues::plain(int count) {
  std::vector<float> values(static_cast<std::size_t>(count));
  std::generate(values.begin(), values.end(), [&] { return value(); });
  return values;
}

std::vector<float> RandomValues::map(int pixels, int channels) {
  const int blocks = (channels + 7) / 8;
  std::vector<float> values(as_size(blocks * pixels * 8));
  for (int b = 0; b < blocks; ++b) {
    for (int p = 0; p < pixels; ++p) {
      for (int lane = 0; lane < 8 && b * 8 + lane < channels; ++lane) {
        values[as_size((b * pixels + p) * 8 + lane)] = value();
      }
    }
  }
  return values;
}

float RandomValues::weight() {
  const float ordinary = std::normal_distribution<float>(0.0f, 0.3f)(random_);
  switch (pattern_) {
    case Pattern::kCancelling:
      return coin() ? 0.75f : -0.75f;
    case Pattern::kDenormal:
      return ordinary * (coin() ? 1e-6f : 1.0f);
    case Pattern::kHuge:
      return between(0, 31) == 0 ? std::copysign(is_half() ? 16.0f : 65504.0f, ordinary) : ordinary;
    case Pattern::kOrdinary:
      return ordinary;
    default:
      return between(0, 15) == 0 ? ordinary * 1e-6f : ordinary;
  }
}

std::vector<std::uint16_t> RandomValues::halves(int count) {
  std::vector<std::uint16_t> values(static_cast<std::size_t>(count));
  std::generate(values.begin(), values.end(), [&] { return formats::fp16_from_float(weight()); });
  return values;
}

std::vector<std::uint16_t> RandomValues::panels(int outputs, int reduction) {
  const int padded = (outputs + 7) / 8 * 8;
  std::vector<std::uint16_t> values = halves(padded * reduction);
  for (int o = outputs; o < padded; ++o) {
    const int first = o / 16 * 16;
    const int width = std::min(16, padded - first);
    for (int k = 0; k < reduction; ++k) {
      values[as_size(first * reduction + k * width + o - first)] = 0;
    }
  }
  return values;
}

std::vector<std::uint16_t> RandomValues::bias(int outputs) {
  std::vector<std::uint16_t> values = halves((outputs + 7) / 8 * 8);
  std::fill(values.begin() + outputs, values.end(), std::uint16_t{0});
  return values;
}

}  // namespace mien::conformance
