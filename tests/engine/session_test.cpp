// Tests of sessions: statuses, memory and the placement of maps.
#include "engine/session.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/arena_plan.h"
#include "formats/mien_writer.h"
#include "tests/engine/mini_model.h"

namespace mien::tests {
namespace {

using engine::Session;
using engine::SessionRequest;
using engine::SessionSize;

TEST(Session, ReportsTheStatusOfEachError) {
  EXPECT_EQ(MiniSession("nobody").status, MIEN_ERROR_WEIGHTS_INCOMPLETE);
  EXPECT_EQ(MiniSession("encoder", {26, 27, 3}).status, MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(MiniSession("pnet", {11, 31, 3}).status, MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(MiniSession("pnet", {31, 31, 4}).status, MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(MiniSession("encoder", {}, 0).status, MIEN_ERROR_UNSUPPORTED_LAYER);
  EXPECT_EQ(MiniSession("encoder").status, MIEN_OK);
}

// At 5 x 5 the second window begins at 4. At 8 x 8 a third one would begin beyond the map.
TEST(Session, RejectsSizesAtWhichAPoolingWindowIsEmpty) {
  formats::MienWriter writer;
  formats::NetworkWriter& network = writer.network("net", {5, 5, 8}, true);
  formats::LayerOptions options;
  options.stride_y = options.stride_x = 4;
  options.ceil_mode = true;
  network.output(network.max_pool(0, 2, 2, options));
  std::vector<std::byte> file;
  ASSERT_EQ(writer.finish(&file).status, MIEN_OK);
  EXPECT_EQ(OwnedSession(AlignedBuffer(file), "net", {5, 5, 8}).status, MIEN_OK);
  EXPECT_EQ(OwnedSession(AlignedBuffer(file), "net", {9, 9, 8}).status, MIEN_OK);
  EXPECT_EQ(OwnedSession(AlignedBuffer(file), "net", {8, 5, 8}).status, MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(OwnedSession(AlignedBuffer(file), "net", {5, 8, 8}).status, MIEN_ERROR_WEIGHTS_SHAPE);
}

TEST(Session, AsksForItsMemory) {
  AlignedBuffer file = mini_file();
  engine::Model model;
  ASSERT_EQ(model.open(file.span()).status, MIEN_OK);
  const SessionRequest request{&model, "encoder", {}};
  SessionSize size;
  ASSERT_EQ(engine::session_size(request, size), MIEN_OK);
  AlignedBuffer memory(size.session_bytes + 64), arena(size.arena_bytes + 64);
  Session* session = nullptr;
  const auto part = [](AlignedBuffer& buffer, std::size_t from, std::size_t bytes) {
    return buffer.span().subspan(from, bytes);
  };
  EXPECT_EQ(Session::init(request, part(memory, 0, size.session_bytes - 1),
                          part(arena, 0, size.arena_bytes), session),
            MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_EQ(Session::init(request, part(memory, 0, size.session_bytes),
                          part(arena, 0, size.arena_bytes - 1), session),
            MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_EQ(Session::init(request, part(memory, 8, size.session_bytes),
                          part(arena, 0, size.arena_bytes), session),
            MIEN_ERROR_ALIGNMENT);
  EXPECT_EQ(session, nullptr);
  EXPECT_EQ(Session::init(request, part(memory, 0, size.session_bytes),
                          part(arena, 0, size.arena_bytes), session),
            MIEN_OK);
  EXPECT_NE(session, nullptr);
}

TEST(Model, RefusesADamagedFile) {
  AlignedBuffer file = mini_file();
  file.span()[file.span().size() / 2] ^= std::byte{1};
  engine::Model model;
  EXPECT_EQ(model.open(file.span()).status, MIEN_ERROR_WEIGHTS_CHECKSUM);
}

// Maps with overlapping lifetimes must not overlap in memory, and the arena must contain all.
TEST(ArenaPlan, LiveMapsNeverOverlap) {
  std::mt19937 random(3);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t count = 1 + below(60);
    struct Placed {
      std::size_t begin, end;
      std::uint32_t last_step;
    };
    std::vector<Placed> maps;
    engine::ArenaPlan arena;
    for (std::uint32_t first_step = 0; first_step < count; ++first_step) {
      const std::size_t bytes = 1 + below(5000);
      const std::uint32_t last_step = first_step + below(6);
      const std::size_t begin = arena.place(bytes, first_step, last_step);
      EXPECT_EQ(begin % engine::kArenaAlignment, 0u);
      EXPECT_LE(begin + bytes, arena.bytes());
      for (const Placed& other : maps) {
        const bool apart = other.end <= begin || begin + bytes <= other.begin;
        EXPECT_TRUE(apart || other.last_step < first_step) << "map " << first_step;
      }
      maps.push_back({begin, begin + bytes, last_step});
    }
  }
}

}  // namespace
}  // namespace mien::tests
