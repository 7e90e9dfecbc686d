#include "tracker/arena.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace mien::tracker {
namespace {

struct Pieces {
  std::span<std::byte> bytes;
  std::span<float> floats;
  std::span<std::byte> last;
};

Pieces lay_out(Arena& arena) {
  Pieces pieces;
  pieces.bytes = arena.take(100);
  pieces.floats = arena.take_array<float>(33);
  pieces.last = arena.take(1);
  return pieces;
}

TEST(Arena, MeasuresWhatItThenHandsOut) {
  Arena measure;
  const Pieces nothing = lay_out(measure);
  EXPECT_TRUE(nothing.bytes.empty() && nothing.floats.empty() && nothing.last.empty());
  EXPECT_TRUE(measure.fits());

  alignas(64) std::byte memory[1024];
  std::memset(memory, 0xAA, sizeof memory);
  Arena arena(std::span<std::byte>(memory).first(measure.used_bytes()));
  const Pieces pieces = lay_out(arena);
  EXPECT_TRUE(arena.fits());
  EXPECT_EQ(arena.used_bytes(), measure.used_bytes());
  EXPECT_EQ(pieces.bytes.size(), 100u);
  EXPECT_EQ(pieces.floats.size(), 33u);
  for (float value : pieces.floats) {
    EXPECT_EQ(value, 0.0f);
  }
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pieces.floats.data()) % Arena::kAlignment, 0u);
  EXPECT_GE(pieces.last.data(), reinterpret_cast<std::byte*>(pieces.floats.data() + 33));
  EXPECT_GE(reinterpret_cast<std::byte*>(pieces.floats.data()), pieces.bytes.data() + 100);
}

TEST(Arena, TooSmallABlockHandsOutNothingBeyond) {
  alignas(64) std::byte memory[192];
  Arena arena(memory);
  EXPECT_FALSE(lay_out(arena).bytes.empty());
  EXPECT_FALSE(arena.fits());
  EXPECT_TRUE(arena.take(1).empty());
}

}  // namespace
}  // namespace mien::tracker
