// The small networks of tests/golden/engine, and the numbers PyTorch made of them.
#pragma once

#include <cstddef>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "engine/model.h"
#include "engine/session.h"

namespace mien::tests {

struct alignas(64) CacheLine {
  std::byte bytes[64];
};

// Bytes at a multiple of 64.
class AlignedBuffer {
 public:
  explicit AlignedBuffer(std::size_t bytes) : lines_((bytes + 63) / 64), size_(bytes) {}
  [[nodiscard]] std::span<std::byte> span() {
    return {reinterpret_cast<std::byte*>(lines_.data()), size_};
  }

 private:
  std::vector<CacheLine> lines_;
  std::size_t size_;
};

inline std::string golden_path(const std::string& name) {
  return std::string(MIEN_SOURCE_DIR) + "/tests/golden/engine/" + name;
}

inline AlignedBuffer read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  AlignedBuffer buffer(static_cast<std::size_t>(file.tellg()));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(buffer.span().data()),
            static_cast<std::streamsize>(buffer.span().size()));
  return buffer;
}

inline std::vector<float> golden(const std::string& name) {
  AlignedBuffer bytes = read_file(golden_path(name + ".f32"));
  const auto* values = reinterpret_cast<const float*>(bytes.span().data());
  return {values, values + bytes.span().size() / sizeof(float)};
}

// A model with one session of one of its networks, in memory of their own.
class MiniSession {
 public:
  explicit MiniSession(const std::string& network, engine::Shape input = {},
                       std::uint32_t cpu_mask = 0xFFFFFFFF)
      : file_(read_file(golden_path("mini.mien"))), memory_(0), arena_(0) {
    status = model_.open(file_.span());
    const engine::SessionRequest request{&model_, network, input, cpu_mask};
    engine::SessionSize size;
    if (status == engine::Status::kOk) {
      status = engine::session_size(request, size);
    }
    if (status == engine::Status::kOk) {
      memory_ = AlignedBuffer(size.session_bytes);
      arena_ = AlignedBuffer(size.arena_bytes);
      status = engine::Session::init(request, memory_.span(), arena_.span(), session);
    }
  }

  engine::Status status = engine::Status::kOk;
  engine::Session* session = nullptr;

 private:
  AlignedBuffer file_, memory_, arena_;
  engine::Model model_;
};

}  // namespace mien::tests
