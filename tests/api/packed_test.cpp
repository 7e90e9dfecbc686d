// Tests of packed weights through the C API.
#include <gtest/gtest.h>
#include <mien/mien.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "tests/engine/mini_model.h"

namespace mien::tests {
namespace {

using Bytes = std::vector<std::byte>;

Bytes golden_file(const std::string& name) {
  AlignedBuffer file = read_file(MIEN_SOURCE_DIR "/tests/golden/" + name);
  return {file.span().begin(), file.span().end()};
}

class Packed : public testing::Test {
 protected:
  mien_status size_of(const Bytes& bytes) {
    return mien_unpacked_bytes(bytes.data(), bytes.size(), &unpacked_bytes);
  }
  mien_status unpack(const Bytes& bytes, std::size_t file_bytes) {
    return mien_unpack(bytes.data(), bytes.size(), memory.data(), file_bytes);
  }
  [[nodiscard]] bool memory_is(std::byte value) const {
    return std::ranges::all_of(memory, [&](std::byte b) { return b == value; });
  }

  static constexpr std::byte kBefore{0xAA};
  const Bytes packed = golden_file("packed/accept/small.packed");
  const Bytes original = golden_file("format/accept/small.mien");
  std::size_t unpacked_bytes = 0;
  alignas(MIEN_ALIGNMENT) std::array<std::byte, 4096> memory = [] {
    std::array<std::byte, 4096> bytes;
    bytes.fill(kBefore);
    return bytes;
  }();
};

TEST_F(Packed, UnpacksTheOriginalBytes) {
  ASSERT_EQ(size_of(packed), MIEN_OK);
  ASSERT_EQ(unpacked_bytes, original.size());
  ASSERT_EQ(unpack(packed, unpacked_bytes), MIEN_OK);
  EXPECT_EQ(std::memcmp(memory.data(), original.data(), original.size()), 0);
  mien_network_config config;
  mien_network_config_default(&config);
  config.file = memory.data();
  config.file_bytes = unpacked_bytes;
  mien_network* network = nullptr;
  EXPECT_EQ(mien_network_create(&config, &network), MIEN_OK);
  mien_network_destroy(network);
}

TEST_F(Packed, AcceptsAnyAlignment) {
  Bytes shifted(1, std::byte{1});
  shifted.insert(shifted.end(), packed.begin(), packed.end());
  ASSERT_EQ(mien_unpack(shifted.data() + 1, packed.size(), memory.data(), original.size()),
            MIEN_OK);
  EXPECT_EQ(std::memcmp(memory.data(), original.data(), original.size()), 0);
}

TEST_F(Packed, KeepsMemoryBehindTheFile) {
  ASSERT_EQ(unpack(packed, memory.size()), MIEN_OK);
  EXPECT_EQ(std::memcmp(memory.data(), original.data(), original.size()), 0);
  EXPECT_TRUE(std::all_of(memory.begin() + static_cast<std::ptrdiff_t>(original.size()),
                          memory.end(), [](std::byte b) { return b == kBefore; }));
}

TEST_F(Packed, RejectsInvalidArguments) {
  EXPECT_EQ(mien_unpacked_bytes(nullptr, 1, &unpacked_bytes), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_unpacked_bytes(packed.data(), packed.size(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_unpack(nullptr, 1, memory.data(), memory.size()), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_unpack(packed.data(), packed.size(), nullptr, memory.size()),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_unpack(packed.data(), packed.size(), memory.data() + 32, memory.size() - 32),
            MIEN_ERROR_ALIGNMENT);
  EXPECT_EQ(unpack(packed, original.size() - 1), MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_EQ(unpack(packed, 0), MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_TRUE(memory_is(kBefore));
}

TEST_F(Packed, ReportsErrors) {
  const auto expect = [&](const Bytes& bytes, mien_status status) {
    unpacked_bytes = 7;
    EXPECT_EQ(size_of(bytes), status);
    EXPECT_EQ(unpacked_bytes, 7u);
    EXPECT_EQ(unpack(bytes, memory.size()), status);
    EXPECT_TRUE(memory_is(kBefore));
  };
  const auto with = [&](std::size_t at, std::byte value) {
    Bytes bytes = packed;
    bytes[at] = value;
    return bytes;
  };
  expect(original, MIEN_ERROR_WEIGHTS_NOT_PACKED);
  expect(with(8, std::byte{2}), MIEN_ERROR_WEIGHTS_VERSION);
  expect(with(12, std::byte{1}), MIEN_ERROR_WEIGHTS_MALFORMED);
  expect(with(24, std::byte{1}), MIEN_ERROR_WEIGHTS_MALFORMED);
  expect(Bytes(packed.begin(), packed.end() - 1), MIEN_ERROR_WEIGHTS_TRUNCATED);
  expect({}, MIEN_ERROR_NULL_ARGUMENT);
  Bytes longer = packed;
  longer.push_back(std::byte{0});
  expect(longer, MIEN_ERROR_WEIGHTS_MALFORMED);
}

TEST_F(Packed, ZeroesTheFileOnError) {
  Bytes bytes = packed;
  bytes.back() ^= std::byte{1};
  EXPECT_EQ(size_of(bytes), MIEN_OK);
  EXPECT_EQ(unpack(bytes, original.size()), MIEN_ERROR_WEIGHTS_MALFORMED);
  const std::span unpacked(memory.data(), original.size());
  EXPECT_TRUE(std::ranges::all_of(unpacked, [](std::byte b) { return b == std::byte{0}; }));
}

}  // namespace
}  // namespace mien::tests
