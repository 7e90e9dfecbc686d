// Tests of weight files with small damage: they are rejected with a status, or are valid and
// consistent.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "kernels/float_mode.h"
#include "tests/formats/files.h"

namespace mien::formats {
namespace {

std::vector<std::byte> small() { return read_file(golden_folder() + "accept/small.mien"); }
std::vector<std::byte> every_op() { return read_file(golden_folder() + "accept/every_op.mien"); }

TEST(Malformed, TruncatedAtEveryByte) {
  for (const auto& file : {small(), every_op()}) {
    for (std::size_t size = 0; size < file.size(); ++size) {
      EXPECT_EQ(open_copy({file.data(), size}).status, MIEN_ERROR_WEIGHTS_TRUNCATED) << size;
    }
  }
}

TEST(Malformed, TruncatedAtEveryLineWithACorrectSize) {
  const auto file = every_op();
  for (std::size_t size = sizeof(FileHeader); size < file.size(); size += 4) {
    AlignedBytes cut({file.data(), size});
    const std::uint64_t total = size;
    std::memcpy(cut.get().data() + offsetof(FileHeader, total_bytes), &total, sizeof total);
    fix_checksum(cut.get());
    EXPECT_NE(open_copy(cut.get()).status, MIEN_OK) << size;
  }
}

TEST(Malformed, BytesAfterTheEnd) {
  for (const std::size_t more : {1u, 63u, 64u, 4096u}) {
    auto file = small();
    file.resize(file.size() + more);
    EXPECT_EQ(open_copy(file).status, MIEN_ERROR_WEIGHTS_TRAILING_BYTES);
  }
}

TEST(Malformed, EveryBitOfTheFileFlipped) {
  const auto file = small();
  AlignedBytes copy(file);
  FileView view;
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
    const auto mask = std::byte(1 << bit % 8);
    copy.get()[bit / 8] ^= mask;
    const auto status = static_cast<mien_status>(open(copy.get(), view).status);
    EXPECT_NE(status, MIEN_OK) << bit;
    EXPECT_TRUE(bit / 8 < sizeof(FileHeader) || status == MIEN_ERROR_WEIGHTS_CHECKSUM) << bit;
    copy.get()[bit / 8] ^= mask;
  }
}

TEST(Malformed, EveryHeaderBitFlippedWithACorrectChecksum) {
  auto file = every_op();
  constexpr std::size_t kFields = offsetof(FileHeader, checksum);
  for (std::size_t bit = 0; bit < 8 * kFields; ++bit) {
    const auto mask = std::byte(1 << bit % 8);
    file[bit / 8] ^= mask;
    fix_checksum(file);
    EXPECT_NE(open_copy(file).status, MIEN_OK) << bit;
    file[bit / 8] ^= mask;
  }
}

// Only alphas, weights and letters of names may change in a valid file.
TEST(Malformed, EveryBitOfTheRecordsFlippedWithACorrectChecksum) {
  auto file = small();
  FileHeader header;
  std::memcpy(&header, file.data(), sizeof header);
  const auto strings =
      static_cast<std::size_t>(header.data_offset - (header.string_bytes + 63) / 64 * 64);
  std::size_t accepted = 0;
  for (std::size_t bit = 8 * sizeof(FileHeader); bit < 8 * strings; ++bit) {
    const auto mask = std::byte(1 << bit % 8);
    file[bit / 8] ^= mask;
    fix_checksum(file);
    accepted += open_copy(file).status == MIEN_OK ? 1 : 0;
    file[bit / 8] ^= mask;
  }
  EXPECT_LT(accepted, 8 * strings / 20);
}

// Callers may flush denormals to zero, so alphas are compared by their bits.
TEST(Malformed, AlphasAreCheckedByTheirBits) {
  constexpr std::size_t kLeakyAlpha = 192 + 44, kOtherAlpha = kLeakyAlpha + 64;  // of small.mien
  const auto status_with = [](std::size_t at, std::uint32_t bits) {
    auto file = small();
    std::memcpy(file.data() + at, &bits, sizeof bits);
    fix_checksum(file);
    const auto status = static_cast<mien_status>(open_copy(file).status);
    const kernels::FloatMode ours;
    EXPECT_EQ(open_copy(file).status, status);
    return status;
  };
  for (const std::uint32_t good : {0x1u, 0x7FFFFFu, 0x800000u, 0x3E800000u, 0x3F7FFFFFu}) {
    EXPECT_EQ(status_with(kLeakyAlpha, good), MIEN_OK) << good;
    EXPECT_EQ(status_with(kOtherAlpha, good), MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION) << good;
  }
  for (const std::uint32_t bad : {0u, 0x3F800000u, 0x7F800000u, 0x7FC00000u, 0x80000000u,
                                  0x80000001u, 0xBE800000u, 0xFFFFFFFFu}) {
    EXPECT_EQ(status_with(kLeakyAlpha, bad), MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION) << bad;
    EXPECT_EQ(status_with(kOtherAlpha, bad),
              bad == 0 ? MIEN_OK : MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION)
        << bad;
  }
}

template <class Integer>
std::vector<Integer> boundary_values() {
  using Limits = std::numeric_limits<Integer>;
  std::vector<Integer> values = {0, 1, 2, 7, 8, 15, 16, 63, 64, 127, 128, 255};
  for (int power = 8; power < std::numeric_limits<Integer>::digits; ++power) {
    for (const int delta : {-1, 0, 1}) {
      values.push_back(
          static_cast<Integer>((std::uint64_t{1} << power) + static_cast<std::uint64_t>(delta)));
    }
  }
  for (const unsigned below : {0u, 1u, 2u, 3u, 7u, 15u, 31u, 63u, 64u}) {
    values.push_back(static_cast<Integer>(Limits::max() - below));
  }
  return values;
}

// Writes each boundary value over every aligned integer of its size, whatever field it is.
template <class Integer>
void try_boundaries(std::size_t begin, std::size_t end) {
  const auto original = small();
  auto file = original;
  for (std::size_t at = begin; at < end; at += sizeof(Integer)) {
    for (const Integer value : boundary_values<Integer>()) {
      std::memcpy(file.data() + at, &value, sizeof value);
      const bool same = file == original;
      fix_checksum(file);
      const auto status = static_cast<mien_status>(open_copy(file).status);
      EXPECT_FALSE(status_name(status).empty());
      EXPECT_TRUE(!same || status == MIEN_OK);
      EXPECT_NE(status, MIEN_ERROR_WEIGHTS_CHECKSUM);
      std::memcpy(file.data(), original.data(), sizeof(FileHeader));
      std::memcpy(file.data() + at, original.data() + at, sizeof value);
    }
  }
}

constexpr std::size_t kRecordsEnd = 1056;  // of small.mien

TEST(Malformed, BoundaryValuesInEveryByte) { try_boundaries<std::uint8_t>(0, 56); }
TEST(Malformed, BoundaryValuesInEvery16BitField) { try_boundaries<std::uint16_t>(64, kRecordsEnd); }
TEST(Malformed, BoundaryValuesInEvery32BitField) {
  try_boundaries<std::uint32_t>(0, 56);
  try_boundaries<std::uint32_t>(64, kRecordsEnd);
}
TEST(Malformed, BoundaryValuesInEvery64BitField) {
  try_boundaries<std::uint64_t>(0, 56);
  try_boundaries<std::uint64_t>(64, kRecordsEnd);
}

TEST(Malformed, MisalignedMemory) {
  const auto file = small();
  std::vector<std::byte> shifted(file.size() + 1);
  AlignedBytes bytes(shifted);
  std::memcpy(bytes.get().data() + 1, file.data(), file.size());
  FileView view;
  EXPECT_EQ(open(bytes.get().subspan(1), view).status, MIEN_ERROR_ALIGNMENT);
}

TEST(Malformed, AViewIsClearedAfterARejectedFile) {
  const auto file = small();
  AlignedBytes good(file);
  FileView view;
  ASSERT_EQ(open(good.get(), view).status, MIEN_OK);
  AlignedBytes bad({file.data(), file.size() - 1});
  ASSERT_EQ(open(bad.get(), view).status, MIEN_ERROR_WEIGHTS_TRUNCATED);
  EXPECT_TRUE(view.networks().empty());
  EXPECT_EQ(view.find_network("a"), nullptr);
  EXPECT_EQ(view.find_constant("c"), nullptr);
  EXPECT_EQ(view.checksum(), 0u);
}

}  // namespace
}  // namespace mien::formats
