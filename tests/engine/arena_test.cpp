// Tests of the arena that measures and then hands out memory.
#include "engine/arena.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

namespace mien::engine {
namespace {

struct Pieces {
  std::span<std::byte> first, second, last, shared, shared_too;
};

Pieces lay_out(Arena& arena) {
  Pieces pieces;
  pieces.first = arena.take(100);
  pieces.shared = arena.share(70);
  pieces.second = arena.take(64);
  pieces.shared_too = arena.share(200);
  pieces.last = arena.take(1);
  return pieces;
}

TEST(Arena, MeasuresWhatItThenHandsOut) {
  Arena measure;
  const Pieces nothing = lay_out(measure);
  EXPECT_TRUE(nothing.first.empty() && nothing.last.empty() && nothing.shared.empty());
  const Arena::Need need = measure.need();
  EXPECT_EQ(need.own_bytes, 128u + 64u + 64u);
  EXPECT_EQ(need.shared_bytes, 256u);

  alignas(64) std::byte memory[512];
  ASSERT_EQ(need.total_bytes(), sizeof memory);
  Arena arena(memory, need);
  const Pieces pieces = lay_out(arena);
  for (const auto& piece :
       {pieces.first, pieces.second, pieces.last, pieces.shared, pieces.shared_too}) {
    ASSERT_FALSE(piece.empty());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(piece.data()) % Arena::kAlignment, 0u);
    EXPECT_GE(piece.data(), memory);
    EXPECT_LE(piece.data() + piece.size(), memory + sizeof memory);
  }
  EXPECT_EQ(pieces.shared.data(), pieces.shared_too.data());
  std::memset(memory, 0, sizeof memory);
  std::memset(pieces.first.data(), 1, pieces.first.size());
  std::memset(pieces.second.data(), 1, pieces.second.size());
  std::memset(pieces.last.data(), 1, pieces.last.size());
  std::memset(pieces.shared_too.data(), 1, pieces.shared_too.size());
  std::size_t written = 0;
  for (std::byte byte : memory) {
    written += static_cast<std::size_t>(byte);
  }
  EXPECT_EQ(written, 100u + 64u + 1u + 200u) << "no piece overlaps another";
}

TEST(Arena, HandsOutNothingBeyondItsRoom) {
  alignas(64) std::byte memory[192 + 64];
  Arena arena(memory, {192, 64});
  const Pieces pieces = lay_out(arena);
  EXPECT_FALSE(pieces.second.empty());
  EXPECT_TRUE(pieces.last.empty());
  EXPECT_TRUE(pieces.shared.empty() && pieces.shared_too.empty());
}

}  // namespace
}  // namespace mien::engine
