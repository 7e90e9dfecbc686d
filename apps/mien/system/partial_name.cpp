// Generates unpredictable names of temporary files.
#include "apps/mien/system/partial_name.h"

#include <random>
#include <string_view>

namespace mien::app {

std::string partial_name(const std::string& ending) {
  constexpr std::string_view kDigits = "abcdefghijklmnopqrstuvwxyz234567";
  constexpr int kLength = 16;
  constexpr std::size_t kLongestEnding = 16;
  std::random_device random;
  std::uniform_int_distribution<std::size_t> digit(0, kDigits.size() - 1);
  std::string name = ".partial-";
  for (int i = 0; i < kLength; ++i) {
    name += kDigits[digit(random)];
  }
  return ending.size() <= kLongestEnding ? name + ending : name;
}

}  // namespace mien::app
