// Tests of packed weight files: unpacking restores every byte, and damage is rejected or fails the
// checksum of the result.
#include "formats/packed_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/formats/files.h"

namespace mien::formats {
namespace {

constexpr std::size_t kUnpackedBytesAt = 24;
constexpr std::size_t kHeaderBytes = 32;

using Bytes = std::vector<std::byte>;

std::string folder() { return MIEN_SOURCE_DIR "/tests/golden/packed/"; }
Bytes small_packed() { return read_file(folder() + "accept/small.packed"); }

std::string packed_status_name(mien_status status) {
  constexpr std::pair<mien_status, const char*> kNames[] = {
      {MIEN_OK, "kOk"},
      {MIEN_ERROR_WEIGHTS_TRUNCATED, "kTruncated"},
      {MIEN_ERROR_WEIGHTS_TRAILING_BYTES, "kTrailingBytes"},
      {MIEN_ERROR_WEIGHTS_NOT_MIEN, "kNotPacked"},
      {MIEN_ERROR_WEIGHTS_VERSION, "kUnsupportedVersion"},
      {MIEN_ERROR_WEIGHTS_RESERVED, "kReservedNotZero"},
      {MIEN_ERROR_WEIGHTS_PACKED_SIZE, "kBadSize"},
      {MIEN_ERROR_MEMORY_TOO_SMALL, "kWrongSize"},
      {MIEN_ERROR_WEIGHTS_PACKED_BLOCK, "kBadBlock"},
      {MIEN_ERROR_WEIGHTS_PACKED_TABLE, "kBadTable"},
      {MIEN_ERROR_WEIGHTS_PACKED_STATE, "kBadState"},
      {MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED, "kBytesMissing"},
      {MIEN_ERROR_WEIGHTS_PACKED_TRAILING, "kBytesLeft"},
  };
  return name_in(kNames, status);
}

mien_status unpacked_bytes(std::span<const std::byte> packed, std::size_t& bytes) {
  mien_error_detail error = detail_of(MIEN_OK);
  const mien_status status = formats::unpacked_bytes(packed, bytes, error);
  EXPECT_EQ(error.status, status);
  EXPECT_LE(error.offset, packed.size());
  return status;
}

mien_status unpack(std::span<const std::byte> packed, std::span<std::byte> file) {
  mien_error_detail error = detail_of(MIEN_OK);
  const mien_status status = formats::unpack(packed, file, error);
  EXPECT_EQ(error.status, status);
  EXPECT_LE(error.offset, packed.size());
  return status;
}

// The status, and the result in memory that was not zero before.
mien_status unpack_copy(std::span<const std::byte> packed, Bytes* file) {
  AlignedBytes copy(packed);
  std::size_t bytes = 0;
  const mien_status status = unpacked_bytes(copy.get(), bytes);
  file->assign(bytes, std::byte{0xAA});
  return status == MIEN_OK ? unpack(copy.get(), *file) : status;
}

mien_status status_of(std::span<const std::byte> packed) {
  Bytes file;
  const mien_status status = unpack_copy(packed, &file);
  if (status != MIEN_OK) {
    EXPECT_TRUE(std::ranges::all_of(file, [](std::byte b) { return b == std::byte{0}; }));
  }
  return status;
}

template <class Number>
Bytes with(Bytes packed, std::size_t at, Number number) {
  std::memcpy(packed.data() + at, &number, sizeof number);
  return packed;
}

// name -> status of the Python reader, which writes the result to `out`.
std::map<std::string, std::string> second_reader(const std::string& kind, const std::string& out) {
  std::istringstream lines(output_of(std::string(kPython) + " " + folder() + "second_unpacker.py " +
                                     out + " " + folder() + kind + "/*.packed"));
  std::map<std::string, std::string> found;
  for (std::string name, status; lines >> name >> status;) {
    found[name] = status;
  }
  return found;
}

TEST(PackedFiles, GoldenOnesAreUnpacked) {
  const auto files = files_in(folder() + "accept", ".packed");
  ASSERT_EQ(files.size(), 5u);
  for (const std::string& path : files) {
    Bytes file;
    ASSERT_EQ(packed_status_name(unpack_copy(read_file(path), &file)), "kOk") << path;
    EXPECT_EQ(open_copy(file).status, MIEN_OK) << path;
    const std::string original =
        golden_folder() + "accept/" + std::filesystem::path(path).stem().string() + ".mien";
    if (name_of(path) != "zeros.packed") {
      EXPECT_TRUE(file == read_file(original)) << path;
    }
  }
}

TEST(PackedFiles, GoldenOnesAreRejectedForTheRightReason) {
  std::ifstream expected(folder() + "reject/expected.txt");
  std::set<std::string> statuses;
  std::size_t count = 0;
  for (std::string name, status; expected >> name >> status; ++count) {
    EXPECT_EQ(packed_status_name(status_of(read_file(folder() + "reject/" + name))), status)
        << name;
    statuses.insert(status);
  }
  EXPECT_EQ(count, files_in(folder() + "reject", ".packed").size());
  std::set<std::string> all;
  for (int i = -150; i <= 0; ++i) {
    all.insert(packed_status_name(static_cast<mien_status>(i)));
  }
  for (const char* other : {"", "kOk", "kWrongSize"}) {  // which no file can cause
    all.erase(other);
  }
  EXPECT_EQ(statuses, all);
}

TEST(PackedFiles, SecondReaderAgrees) {
  if (!std::filesystem::exists(kPython)) {
    GTEST_SKIP() << "no " << kPython;
  }
  const std::string out = testing::TempDir() + "mien_unpacked/";
  std::filesystem::create_directory(out);
  for (const std::string kind : {"accept", "reject"}) {
    const auto second = second_reader(kind, out);
    for (const std::string& path : files_in(folder() + kind, ".packed")) {
      Bytes file;
      const mien_status status = unpack_copy(read_file(path), &file);
      EXPECT_EQ(second.at(name_of(path)), packed_status_name(status)) << path;
      if (status == MIEN_OK) {
        EXPECT_TRUE(file == read_file(out + name_of(path))) << path;
      }
    }
  }
  std::filesystem::remove_all(out);
}

void pack(const std::string& path, const std::string& packed) {
  output_of(std::string(kPython) + " " MIEN_SOURCE_DIR "/scripts/package/pack_weights.py " + path +
            " " + packed);
}

TEST(PackedFiles, ShippedWeightsRoundTrip) {
  if (!std::filesystem::exists(kPython)) {
    GTEST_SKIP() << "no " << kPython;
  }
  const std::string packed = testing::TempDir() + "mien_weights.packed";
  const auto files = files_in(MIEN_SOURCE_DIR "/models", ".mien");
  EXPECT_GE(files.size(), 4u);
  for (const std::string& path : files) {
    pack(path, packed);
    const Bytes original = read_file(path);
    const Bytes bytes = read_file(packed);
    EXPECT_LT(bytes.size(), original.size() * 3 / 4) << path;
    Bytes file;
    EXPECT_EQ(packed_status_name(unpack_copy(bytes, &file)), "kOk") << path;
    EXPECT_TRUE(file == original) << path;
  }
  std::filesystem::remove(packed);
}

TEST(PackedFiles, TruncatedAtEveryByte) {
  const Bytes packed = small_packed();
  for (std::size_t size = 0; size < packed.size(); ++size) {
    const Bytes cut(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(status_of(cut), MIEN_ERROR_WEIGHTS_TRUNCATED) << size;
    if (size >= kHeaderBytes) {
      const mien_status status = status_of(with(cut, kPackedBytesAt, std::uint64_t{size}));
      EXPECT_TRUE(status == MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED ||
                  status == MIEN_ERROR_WEIGHTS_PACKED_SIZE)
          << size;
    }
  }
}

TEST(PackedFiles, BytesAfterTheEnd) {
  for (const std::size_t more : {1u, 2u, 63u, 4096u}) {
    Bytes packed = small_packed();
    packed.resize(packed.size() + more);
    EXPECT_EQ(status_of(packed), MIEN_ERROR_WEIGHTS_TRAILING_BYTES);
    const std::uint64_t size = packed.size();
    EXPECT_EQ(status_of(with(packed, kPackedBytesAt, size)), MIEN_ERROR_WEIGHTS_PACKED_TRAILING);
  }
}

TEST(PackedFiles, EveryFlippedBitIsDetectedByTheUnpackedFileAtTheLatest) {
  Bytes packed = small_packed();
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * packed.size(); ++bit) {
    packed[bit / 8] ^= std::byte(1 << bit % 8);
    Bytes file;
    if (unpack_copy(packed, &file) != MIEN_OK) {
      ++refused;
    } else {
      EXPECT_NE(open_copy(file).status, MIEN_OK) << bit;
    }
    packed[bit / 8] ^= std::byte(1 << bit % 8);
  }
  // Exchanging slots of equally frequent bytes keeps the states unchanged.
  EXPECT_GT(refused, 8 * packed.size() * 9 / 10);
}

TEST(PackedFiles, HostileSizesAreRejectedBeforeAllocation) {
  const Bytes packed = small_packed();
  const std::uint64_t most = (packed.size() - kHeaderBytes) / 80 * 65536;
  for (const std::uint64_t size : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{63}, most + 64,
                                   (std::uint64_t{1} << 31) + 64, std::uint64_t{1} << 32,
                                   std::uint64_t{1} << 63, ~std::uint64_t{0}, ~std::uint64_t{63}}) {
    std::size_t bytes = 7;
    EXPECT_EQ(unpacked_bytes(with(packed, kUnpackedBytesAt, size), bytes),
              MIEN_ERROR_WEIGHTS_PACKED_SIZE);
    EXPECT_EQ(bytes, 7u);
  }
  EXPECT_EQ(status_of(with(packed, kUnpackedBytesAt, most)), MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED);
}

TEST(PackedFiles, MemoryOfAnotherSizeIsRejected) {
  const Bytes packed = small_packed();
  std::size_t bytes = 0;
  ASSERT_EQ(unpacked_bytes(packed, bytes), MIEN_OK);
  for (const std::size_t size : {std::size_t{0}, bytes - 1, bytes + 1}) {
    Bytes file(size, std::byte{0xAA});
    EXPECT_EQ(unpack(packed, file), MIEN_ERROR_MEMORY_TOO_SMALL);
    EXPECT_TRUE(std::ranges::all_of(file, [](std::byte b) { return b == std::byte{0xAA}; }));
  }
}

}  // namespace
}  // namespace mien::formats
