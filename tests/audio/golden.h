// Reads reference values from tests/golden/audio/.
#pragma once

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace mien::tests {

inline std::vector<float> golden(const std::string& name) {
  std::ifstream file(std::string(MIEN_SOURCE_DIR "/tests/golden/audio/") + name, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

}  // namespace mien::tests
