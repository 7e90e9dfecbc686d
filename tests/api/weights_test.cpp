// Tests of weights: files, bundles, packed files, alignment, ownership and errors.
#include <gtest/gtest.h>
#include <mien/engine.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <new>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/mien_format.h"
#include "formats/xxhash64.h"
#include "tests/engine/mini_model.h"

namespace mien::tests {
namespace {

using Bytes = std::vector<std::byte>;

Bytes golden_file(const std::string& name) {
  AlignedBuffer file = read_file(MIEN_SOURCE_DIR "/tests/golden/" + name);
  return {file.span().begin(), file.span().end()};
}

Bytes joined(std::initializer_list<Bytes> files) {
  Bytes all;
  for (const Bytes& file : files) {
    all.insert(all.end(), file.begin(), file.end());
  }
  return all;
}

// With a correct checksum.
template <class Number>
Bytes with(Bytes file, std::size_t at, Number value) {
  constexpr std::size_t kChecksumAt = offsetof(formats::FileHeader, checksum);
  std::memcpy(file.data() + at, &value, sizeof value);
  const std::uint64_t checksum = formats::xxhash64_with_hole(file, kChecksumAt);
  std::memcpy(file.data() + kChecksumAt, &checksum, sizeof checksum);
  return file;
}

class WeightsTest : public testing::Test {
 protected:
  mien_status create(std::span<const std::byte> file, bool copy = true) {
    return weights.create({&file, 1}, copy, &error);
  }
  std::vector<std::string> networks() const {
    std::vector<std::string> names;
    const WeightsContent content(weights);
    for (std::int32_t i = 0; i < content.network_count(); ++i) {
      names.emplace_back(content.network(i).name);
    }
    return names;
  }

  const Bytes small = golden_file("format/accept/small.mien");
  const Bytes packed = golden_file("packed/accept/small.packed");
  const Bytes other = golden_file("format/accept/every_op.mien");
  Weights weights;
  Error error;
};

TEST_F(WeightsTest, OpensFilesInPlaceIfTheyAreAligned) {
  AlignedBuffer aligned = mini_file();
  ASSERT_EQ(create(aligned.span(), false), MIEN_OK);
  const std::string_view value = WeightsContent(weights).metadata(0).text();
  const auto* begin = reinterpret_cast<const char*>(aligned.span().data());
  EXPECT_TRUE(value.data() > begin && value.data() < begin + aligned.span().size());
}

TEST_F(WeightsTest, CopiesOtherFiles) {
  AlignedBuffer shifted(small.size() + 8);
  std::copy(small.begin(), small.end(), shifted.span().begin() + 8);
  ASSERT_EQ(create(shifted.span().subspan(8), false), MIEN_OK);
  const std::vector<std::string> names = networks();
  EXPECT_FALSE(names.empty());
  std::fill(shifted.span().begin(), shifted.span().end(), std::byte{0xAA});
  EXPECT_EQ(networks(), names);
}

TEST_F(WeightsTest, TellsInputBounds) {
  ASSERT_EQ(create(golden_file("format/accept/input_bounds.mien")), MIEN_OK);
  const WeightsContent content(weights);
  const float bounds[] = {3.25f, 0.0f, 6.0f, 0.0f, 0.0f};
  for (std::int32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(content.layer(0, i).input_bound, bounds[i]) << "layer " << i;
  }
}

TEST_F(WeightsTest, NamesAnInputBoundOutsideItsLimits) {
  EXPECT_EQ(create(golden_file("format/reject/bound_negative.mien")),
            MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION);
  EXPECT_STREQ(error.field, "input_bound");
}

TEST_F(WeightsTest, UnpacksPackedFilesOfAnyAlignment) {
  ASSERT_EQ(create(small), MIEN_OK);
  const std::vector<std::string> names = networks();
  for (const std::size_t shift : {0u, 1u, 8u}) {
    Bytes shifted(shift, std::byte{1});
    shifted.insert(shifted.end(), packed.begin(), packed.end());
    ASSERT_EQ(create(std::span(shifted).subspan(shift), false), MIEN_OK) << shift;
    EXPECT_EQ(networks(), names);
  }
}

TEST_F(WeightsTest, OpensBundles) {
  ASSERT_EQ(create(small), MIEN_OK);
  const std::vector<std::string> first = networks();
  ASSERT_EQ(create(other), MIEN_OK);
  std::vector<std::string> both = networks();
  both.insert(both.end(), first.begin(), first.end());
  EXPECT_EQ(create(joined({other, small})), MIEN_OK);
  EXPECT_EQ(networks(), both);
  EXPECT_EQ(create(joined({other, packed})), MIEN_OK);
  EXPECT_EQ(networks(), both);
  EXPECT_EQ(create(joined({packed, small, packed, other})), MIEN_OK);
  EXPECT_EQ(networks().size(), 2 * first.size() + both.size());
}

TEST_F(WeightsTest, LocatesErrorsInBundles) {
  Bytes damaged = other;
  damaged[damaged.size() / 2] ^= std::byte{1};
  EXPECT_EQ(create(joined({small, damaged})), MIEN_ERROR_WEIGHTS_CHECKSUM);
  EXPECT_EQ(error.offset, small.size() + offsetof(formats::FileHeader, checksum));
  EXPECT_EQ(create(joined({small, Bytes(64)})), MIEN_ERROR_WEIGHTS_TRAILING_BYTES);
  EXPECT_EQ(error.offset, small.size());
  Bytes cut = joined({small, other});
  cut.resize(cut.size() - 64);
  EXPECT_EQ(create(cut), MIEN_ERROR_WEIGHTS_TRUNCATED);
  EXPECT_EQ(error.offset, cut.size());
  EXPECT_EQ(error.file, 0);
  Bytes damaged_block = packed;
  damaged_block.back() ^= std::byte{1};
  EXPECT_EQ(create(joined({small, damaged_block})), MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED);
  EXPECT_GT(error.offset, small.size());
}

TEST_F(WeightsTest, NamesTheFileOfAnError) {
  const std::span<const std::byte> files[] = {small, {}, other, std::span(small).first(64)};
  EXPECT_EQ(weights.create(files, true, &error), MIEN_ERROR_WEIGHTS_TRUNCATED);
  EXPECT_EQ(error.file, 3);
  EXPECT_FALSE(weights);
}

TEST_F(WeightsTest, AnEmptyFileIsTruncatedWhateverItsAlignment) {
  AlignedBuffer memory = mini_file();
  for (const std::size_t shift : {0U, 8U}) {
    for (const bool copy : {false, true}) {
      EXPECT_EQ(create(memory.span().subspan(shift, 0), copy), MIEN_ERROR_WEIGHTS_TRUNCATED);
    }
  }
}

TEST_F(WeightsTest, RejectsInvalidArguments) {
  mien_weights_config config;
  mien_weights_config_default(&config);
  auto* created = reinterpret_cast<mien_weights*>(&config);  // must be overwritten
  EXPECT_EQ(mien_weights_create(&config, &created, &error), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(created, nullptr);
  EXPECT_STREQ(error.field, "files");
  EXPECT_EQ(mien_weights_create(nullptr, &created, &error), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_STREQ(error.field, "config");
  EXPECT_EQ(mien_weights_create(&config, nullptr, &error), MIEN_ERROR_NULL_ARGUMENT);
  config.files[0] = small.data();
  config.file_bytes[0] = small.size();
  config.allocator.release = [](void*, void*) {};
  EXPECT_EQ(mien_weights_create(&config, &created, &error), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_STREQ(error.field, "allocator");
  config.struct_size = 8;
  EXPECT_EQ(mien_weights_create(&config, &created, &error), MIEN_ERROR_STRUCT_SIZE);
  mien_weights_config_default(nullptr);
  mien_weights_destroy(nullptr);
  EXPECT_EQ(mien_weights_network_count(nullptr), 0);
  Bytes many;
  for (int i = 0; i < 17; ++i) {
    many = joined({many, small});
  }
  EXPECT_EQ(create(many), MIEN_ERROR_WEIGHTS_LIMIT);
  EXPECT_EQ(create(std::span(many).first(16 * small.size())), MIEN_OK);
}

struct CountingMemory {
  int allocations = 0, releases = 0;
  bool empty = false;

  mien_allocator callbacks() {
    mien_allocator allocator = {};
    allocator.user = this;
    allocator.allocate = [](void* user, size_t size, size_t alignment) -> void* {
      auto& self = *static_cast<CountingMemory*>(user);
      ++self.allocations;
      return self.empty ? nullptr : ::operator new (size, std::align_val_t{alignment});
    };
    allocator.release = [](void* user, void* memory) {
      ++static_cast<CountingMemory*>(user)->releases;
      ::operator delete (memory, std::align_val_t{MIEN_ALIGNMENT});
    };
    return allocator;
  }
};

TEST_F(WeightsTest, AllocateOnceAndAreReleasedWithTheLastUser) {
  CountingMemory memory;
  mien_weights_config config;
  mien_weights_config_default(&config);
  config.allocator = memory.callbacks();
  config.copy = 1;
  config.files[0] = small.data();
  config.file_bytes[0] = small.size();
  mien_weights* shared = nullptr;
  ASSERT_EQ(mien_weights_create(&config, &shared, nullptr), MIEN_OK);
  EXPECT_EQ(memory.allocations, 1);
  mien_network_config of_network;
  mien_network_config_default(&of_network);
  of_network.weights = shared;
  mien_network *a = nullptr, *b = nullptr;
  ASSERT_EQ(mien_network_create(&of_network, &a, nullptr), MIEN_OK);
  ASSERT_EQ(mien_network_create(&of_network, &b, nullptr), MIEN_OK);
  mien_weights_destroy(shared);
  mien_network_destroy(a);
  EXPECT_EQ(memory.releases, 0);
  EXPECT_EQ(mien_network_run(b), MIEN_OK);
  mien_network_destroy(b);
  EXPECT_EQ(memory.releases, 1);
  const Bytes damaged = with(small, 8, std::uint16_t{9});
  config.files[0] = damaged.data();
  EXPECT_EQ(mien_weights_create(&config, &shared, nullptr), MIEN_ERROR_WEIGHTS_VERSION);
  EXPECT_EQ(memory.allocations, memory.releases);
  memory.empty = true;
  EXPECT_EQ(mien_weights_create(&config, &shared, nullptr), MIEN_ERROR_OUT_OF_MEMORY);
}

TEST_F(WeightsTest, DescribesWhatIsMalformed) {
  const auto message_of = [&](const Bytes& file) {
    EXPECT_NE(create(file), MIEN_OK);
    return error.message();
  };
  EXPECT_EQ(message_of(with(small, 8, std::uint16_t{9})),
            "byte 8, major_version: the weight file has an unsupported format version (got 9, "
            "expected 1)");
  EXPECT_EQ(message_of(with(small, offsetof(formats::FileHeader, network_count), 65u)),
            "byte 20, network_count: a count or size in the weight file exceeds its limit (got 65, "
            "expected 1..64)");
  Bytes longer = small;
  longer.resize(longer.size() + 5);
  EXPECT_EQ(message_of(longer), "byte " + std::to_string(small.size()) +
                                    ", file: the weight file has bytes after its end");
  Bytes damaged = small;
  damaged.back() ^= std::byte{1};
  EXPECT_EQ(message_of(damaged), "byte 56, checksum: the weight file is damaged: wrong checksum");
  EXPECT_EQ(message_of(golden_file("format/reject/input_beyond.mien")).find("network "), 0u);
  EXPECT_GE(error.layer, 0);
}

// Status and place tell the malformed golden files apart.
TEST_F(WeightsTest, TellsMalformedFilesApart) {
  std::set<std::int32_t> statuses;
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(MIEN_SOURCE_DIR "/tests/golden/format/reject")) {
    if (entry.path().extension() != ".mien") {
      continue;
    }
    ++files;
    AlignedBuffer file = read_file(entry.path().string());
    if (file.span().empty()) {
      continue;  // without an address it is no file
    }
    const mien_status status = create(file.span());
    EXPECT_NE(status, MIEN_OK) << entry.path();
    EXPECT_EQ(error.status, status);
    EXPECT_NE(error.known & MIEN_DETAIL_OFFSET, 0u) << entry.path();
    EXPECT_EQ(error.message().starts_with("network "), error.network >= 0) << error.message();
    EXPECT_LT(error.message().size(), 256u) << error.message();
    statuses.insert(status);
  }
  EXPECT_GT(files, 50u);
  EXPECT_GE(statuses.size(), 24u);
}

TEST(ErrorDetail, IsTruncatedToTheBuffer) {
  Error error;
  EXPECT_EQ(error.message(), "ok");
  error.status = MIEN_ERROR_OUT_OF_RANGE;
  error.field = "field";
  error.known = MIEN_DETAIL_GOT | MIEN_DETAIL_EXPECTED;
  error.got = -12.000001;
  error.expected_min = 0.000001;
  error.expected_max = 1e300;
  const std::string whole =
      "field: a value is out of range (got -12.000001, expected 0.000001..infinity)";
  EXPECT_EQ(error.message(), whole);
  char text[10] = "xxxxxxxxx";
  EXPECT_EQ(mien_error_message(&error, text, sizeof text), whole.size());
  EXPECT_STREQ(text, "field: a ");
  EXPECT_EQ(mien_error_message(&error, text, 0), whole.size());
  EXPECT_EQ(mien_error_message(nullptr, text, sizeof text), 0u);
  EXPECT_STREQ(text, "");
  mien_error_detail_default(nullptr);
}

TEST(ErrorDetail, OfAnotherVersionIsWrittenAsFarAsItGoes) {
  mien_weights_config config;
  mien_weights_config_default(&config);
  mien_weights* weights = nullptr;
  mien_error_detail older;
  std::memset(&older, 0x5A, sizeof older);
  older.struct_size = offsetof(mien_error_detail, field);
  EXPECT_EQ(mien_weights_create(&config, &weights, &older), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(older.status, MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(older.name[0], 0x5A);
  older.struct_size = 4;
  older.status = 7;
  EXPECT_EQ(mien_weights_create(&config, &weights, &older), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(older.status, 7) << "too small, and ignored";
}

TEST(LoadWeights, ReadsFilesAndFolders) {
  const std::string file = MIEN_SOURCE_DIR "/tests/golden/format/accept/small.mien";
  const LoadedWeights bundle = load_weights(file);
  ASSERT_TRUE(bundle) << bundle.message;
  const LoadedWeights folder = load_weights(MIEN_SOURCE_DIR "/models");
  ASSERT_TRUE(folder) << folder.message;
  Tracker tracker;
  EXPECT_EQ(tracker.create(Config(folder.weights)), MIEN_OK);
  EXPECT_EQ(tracker.set_lod(4), MIEN_OK);
  EXPECT_EQ(tracker.set_audio_offset(0), MIEN_OK);
}

TEST(LoadWeights, NamesTheFileOfAnError) {
  EXPECT_EQ(load_weights("none.mien").message, "none.mien: cannot be read, or is empty");
  const std::string path = MIEN_SOURCE_DIR "/tests/golden/format/reject/magic.mien";
  EXPECT_TRUE(load_weights(path).message.starts_with(path + ": byte 4, magic:"));
  const std::string folder = MIEN_SOURCE_DIR "/tests";
  EXPECT_EQ(load_weights(folder).message, folder + ": no weight files in this folder");
}

}  // namespace
}  // namespace mien::tests
