// The small networks of apps/conformance/golden, and PyTorch's outputs of them.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "tests/engine/owned_session.h"

namespace mien::tests {

inline AlignedBuffer read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  AlignedBuffer buffer(static_cast<std::size_t>(file.tellg()));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(buffer.span().data()),
            static_cast<std::streamsize>(buffer.span().size()));
  return buffer;
}

inline std::string golden_path(const std::string& name) {
  return std::string(MIEN_SOURCE_DIR) + "/apps/conformance/golden/" + name;
}

inline AlignedBuffer mini_file() { return read_file(golden_path("mini.mien")); }

inline std::vector<float> golden(const std::string& name) {
  AlignedBuffer bytes = read_file(golden_path(name + ".f32"));
  const auto* values = reinterpret_cast<const float*>(bytes.span().data());
  return {values, values + bytes.span().size() / sizeof(float)};
}

class MiniSession : public OwnedSession {
 public:
  explicit MiniSession(const std::string& network, engine::Shape input = {},
                       std::uint32_t cpu_mask = 0xFFFFFFFF)
      : OwnedSession(mini_file(), network, input, cpu_mask) {}
};

}  // namespace mien::tests
