// A session that owns its weight file, memory and arena.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/conformance/unwritten.h"
#include "engine/model.h"
#include "engine/session.h"

namespace mien::tests {

struct alignas(64) CacheLine {
  std::byte bytes[64];
};

// Bytes at an address that is a multiple of 64.
class AlignedBuffer {
 public:
  explicit AlignedBuffer(std::size_t bytes) : lines_((bytes + 63) / 64), size_(bytes) {}
  explicit AlignedBuffer(std::span<const std::byte> bytes) : AlignedBuffer(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), span().begin());
  }
  [[nodiscard]] std::span<std::byte> span() {
    return {reinterpret_cast<std::byte*>(lines_.data()), size_};
  }

 private:
  std::vector<CacheLine> lines_;
  std::size_t size_;
};

class OwnedSession {
 public:
  OwnedSession(AlignedBuffer file, const std::string& network, engine::Shape input = {},
               std::uint32_t cpu_mask = 0xFFFFFFFF)
      : file_(std::move(file)), memory_(0), arena_(0) {
    status = static_cast<mien_status>(model_.open(file_.span()).status);
    const engine::SessionRequest request{&model_, network, input, cpu_mask};
    if (status == MIEN_OK) {
      status = engine::session_size(request, size);
    }
    if (status == MIEN_OK) {
      memory_ = AlignedBuffer(size.session_bytes);
      arena_ = AlignedBuffer(size.arena_bytes);
      status = engine::Session::init(request, memory_.span(), arena_.span(), session);
    }
  }

  // Fills the arena with NaNs, because the next run must not depend on its content.
  void fill_arena_with_nan() {
    for (std::byte& one : arena_.span()) {
      one = std::byte{0xFF};
    }
    count_as_unwritten(arena_.span());
  }

  mien_status status = MIEN_OK;
  engine::SessionSize size;
  engine::Session* session = nullptr;

 private:
  AlignedBuffer file_, memory_, arena_;
  engine::Model model_;
};

// Blocks of 8 channels to [h][w][c].
inline std::vector<float> unblocked(std::span<const float> map, const engine::Shape& shape) {
  std::vector<float> values;
  for (std::size_t p = 0; p < shape.pixels(); ++p) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(shape.c); ++c) {
      values.push_back(map[(c / 8 * shape.pixels() + p) * 8 + c % 8]);
    }
  }
  return values;
}

}  // namespace mien::tests
