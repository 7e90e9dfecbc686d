// Tests of creating trackers: configuration, rejected arguments, memory and struct versions.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

class Create : public testing::Test {
 protected:
  mien_status create() {
    Tracker tracker;
    return tracker.create(config_, &error_);
  }
  template <typename Change>
  mien_status create_with(Change change) {
    const BlobConfig before = config_;
    change(config_);
    const mien_status status = create();
    config_ = before;
    return status;
  }

  AlignedBytes basenet_ = blob_basenet();
  AlignedBytes proposal_ = blob_proposal();
  BlobConfig config_ = blob_config(basenet_, proposal_);
  Error error_;
};

TEST_F(Create, SucceedsWithDefaults) { EXPECT_EQ(create(), MIEN_OK); }

TEST_F(Create, RejectsNullArguments) {
  mien_tracker* tracker = nullptr;
  std::size_t bytes = 1;
  EXPECT_EQ(mien_tracker_create(nullptr, &tracker, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_create(&config_, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_create_in(nullptr, nullptr, 0, &tracker, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_create_in(&config_, nullptr, 0, &tracker, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_create_in(&config_, &bytes, 8, nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_required_bytes(nullptr, &bytes, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(bytes, 0u);
  EXPECT_EQ(mien_tracker_required_bytes(&config_, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_reset(nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_set_lod(nullptr, 1), MIEN_ERROR_NULL_ARGUMENT);
  mien_image image;
  mien_image_default(&image);
  EXPECT_EQ(mien_tracker_push_video(nullptr, &image, 0), MIEN_ERROR_NULL_ARGUMENT);
  mien_result result;
  mien_result_default(&result);
  EXPECT_EQ(mien_tracker_get_result(nullptr, &result), MIEN_ERROR_NULL_ARGUMENT);
  Tracker whole;
  ASSERT_EQ(whole.create(config_), MIEN_OK);
  EXPECT_EQ(mien_tracker_push_video(whole.get(), nullptr, 0), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_get_result(whole.get(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_advance(nullptr, 0), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_set_audio_offset(nullptr, 0), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_set_mix(nullptr, 0, 1.0f, 1.0f), MIEN_ERROR_NULL_ARGUMENT);
  mien_tracker_destroy(nullptr);
  mien_audio_default(nullptr);
  mien_tracker_config_default(nullptr);
  mien_image_default(nullptr);
  mien_result_default(nullptr);
  EXPECT_EQ(create_with([](BlobConfig& c) { c.weights = nullptr; }), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(error_.message(), "weights: a pointer argument is NULL");
}

TEST_F(Create, RejectsValuesOutOfRange) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto rejected = [&](auto change) { return create_with(change) == MIEN_ERROR_OUT_OF_RANGE; };
  for (float bad : {-0.1f, 1.1f, kNan}) {
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.accept_probability = bad; })) << bad;
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.lose_probability = bad; })) << bad;
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.proposal_threshold = bad; })) << bad;
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.refine_threshold = bad; })) << bad;
  }
  EXPECT_TRUE(rejected([](BlobConfig& c) {
    c.accept_probability = 0.6f;
    c.lose_probability = 0.61f;
  }));
  for (float bad : {0.0f, 3.2f, kNan}) {
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.horizontal_fov = bad; })) << bad;
  }
  for (int bad : {0, -1, 100'000}) {
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.lose_after_frames = bad; })) << bad;
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.search_interval = bad; })) << bad;
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.proposal_size = bad; })) << bad;
  }
  for (int bad : {0, 5}) {
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.max_lod = bad; })) << bad;
  }
  for (int bad : {0, -1, MIEN_MAX_FACES + 1}) {
    EXPECT_TRUE(rejected([&](BlobConfig& c) { c.max_faces = bad; })) << bad;
  }
  EXPECT_TRUE(rejected([](BlobConfig& c) {
    c.allocator.allocate = [](void*, std::size_t, std::size_t) -> void* { return nullptr; };
  })) << "half an allocator";
  for (int lod : {-1, 2, 4}) {
    EXPECT_EQ(create_with([&](BlobConfig& c) { c.lod = lod; }), MIEN_ERROR_UNSUPPORTED_LOD);
  }
  EXPECT_EQ(create_with([](BlobConfig& c) { c.lod = 0; }), MIEN_OK);
  for (int size : {24, 640}) {
    EXPECT_EQ(create_with([&](BlobConfig& c) { c.proposal_size = size; }), MIEN_OK) << size;
  }
}

TEST_F(Create, DescribesTheFieldThatIsOutOfRange) {
  EXPECT_EQ(create(), MIEN_OK);
  EXPECT_EQ(error_.status, MIEN_OK);
  EXPECT_EQ(create_with([](BlobConfig& c) { c.lose_after_frames = 1001; }),
            MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(error_.status, MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_STREQ(error_.field, "lose_after_frames");
  EXPECT_EQ(error_.message(),
            "lose_after_frames: a value is out of range (got 1001, expected 1..1000)");
  (void)create_with([](BlobConfig& c) { c.horizontal_fov = -0.5f; });
  EXPECT_EQ(error_.message(),
            "horizontal_fov: a value is out of range (got -0.5, expected 0.01..3.1)");
  (void)create_with([](BlobConfig& c) { c.budget_ms = std::numeric_limits<float>::quiet_NaN(); });
  EXPECT_EQ(error_.message(),
            "budget_ms: a value is out of range (got NaN, expected 0.01..1000000)");
  (void)create_with([](BlobConfig& c) { c.lod = 4; });
  EXPECT_EQ(error_.message(), "lod: this level of detail is not supported (got 4, expected 0..1)");
  (void)create_with([](BlobConfig& c) { c.cpu_mask = 0; });
  EXPECT_EQ(error_.status, MIEN_ERROR_UNSUPPORTED_CPU);
}

TEST_F(Create, LevelsOfDetailDependOnTheWeights) {
  const Weights with_hifinet = weights_of({basenet_.get(), proposal_.get(), blob_hifinet().get()});
  for (int lod : {0, 1, 2, 3, 4}) {
    EXPECT_EQ(create_with([&](BlobConfig& c) {
                c.use(with_hifinet);
                c.lod = lod;
              }),
              MIEN_OK)
        << lod;
  }
  for (int lod : {-1, 5}) {
    EXPECT_EQ(create_with([&](BlobConfig& c) {
                c.use(with_hifinet);
                c.lod = lod;
              }),
              MIEN_ERROR_UNSUPPORTED_LOD);
  }
  for (float bad : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(create_with([&](BlobConfig& c) { c.budget_ms = bad; }), MIEN_ERROR_OUT_OF_RANGE);
  }
}

TEST_F(Create, MaxLodLeavesHiFiNetOut) {
  BlobConfig config(weights_of({basenet_.get(), proposal_.get(), blob_hifinet().get()}));
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t all = required_bytes(config, status);
  config.max_lod = 1;
  EXPECT_LT(required_bytes(config, status), all);
  config.lod = 2;
  EXPECT_EQ(required_bytes(config, status), 0u);
  EXPECT_EQ(status, MIEN_ERROR_UNSUPPORTED_LOD);
  config.max_lod = 3;
  Tracker tracker;
  ASSERT_EQ(tracker.create(config), MIEN_OK);
  EXPECT_EQ(tracker.set_lod(3), MIEN_OK);
  EXPECT_EQ(tracker.set_lod(4), MIEN_ERROR_UNSUPPORTED_LOD);
}

TEST_F(Create, RejectsCpuMasksWithoutATier) {
  EXPECT_EQ(create_with([](BlobConfig& c) { c.cpu_mask = 0; }), MIEN_ERROR_UNSUPPORTED_CPU);
  EXPECT_EQ(create_with([](BlobConfig& c) { c.cpu_mask = ~mien_cpu_tiers(); }),
            MIEN_ERROR_UNSUPPORTED_CPU);
  EXPECT_EQ(create_with([](BlobConfig& c) { c.cpu_mask = MIEN_CPU_REF; }), MIEN_OK);
}

TEST_F(Create, RejectsIncompleteWeights) {
  const auto use = [&](std::span<const std::byte> file) {
    return create_with([&](BlobConfig& c) { c.use(weights_of({file})); });
  };
  EXPECT_EQ(use(basenet_.get()), MIEN_ERROR_WEIGHTS_INCOMPLETE);
  EXPECT_EQ(error_.message(), "network pnet: the weight file lacks a required network or constant");
  EXPECT_EQ(use(proposal_.get()), MIEN_ERROR_WEIGHTS_INCOMPLETE);
  EXPECT_STREQ(error_.name, "face_probability");
}

TEST_F(Create, RejectsWeightsOfAnotherShape) {
  const auto status_of = [&](const BlobOptions& options) {
    return create_with([&](BlobConfig& c) {
      c.use(weights_of({proposal_.get(), blob_basenet(options).get()}));
    });
  };
  BlobOptions narrow;
  narrow.features = 128;
  EXPECT_EQ(status_of(narrow), MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(error_.message(),
            "network encoder, output channels: a network or constant in the weight file has the "
            "wrong shape (got 128, expected 256)");
  EXPECT_EQ(error_.file, 1);
  BlobOptions partial;
  partial.with_pose_decoder = false;
  EXPECT_EQ(status_of(partial), MIEN_ERROR_WEIGHTS_INCOMPLETE);
  EXPECT_EQ(error_.message(),
            "network pose_decoder: the weight file lacks a required network or constant");
  BlobOptions head;
  head.head_points = MIEN_LANDMARK_COUNT;
  EXPECT_EQ(status_of(head), MIEN_OK);
  head.head_points = MIEN_LANDMARK_COUNT - 1;
  EXPECT_EQ(status_of(head), MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(error_.message(),
            "constant head_points: a network or constant in the weight file has the wrong shape "
            "(got 522, expected 525)");
}

TEST_F(Create, KeepsItsWeights) {
  Tracker tracker;
  {
    const BlobConfig config = blob_config(blob_basenet(), blob_proposal());
    ASSERT_EQ(tracker.create(config), MIEN_OK);
  }
  const Buffer disc(disc_picture(160.0f, 120.0f, 70.0f), {});
  EXPECT_EQ(tracker.push_video(disc.image(), 0), MIEN_OK);
}

TEST_F(Create, AcceptsConfigurationsOfOtherVersions) {
  EXPECT_EQ(create_with([](BlobConfig& c) { c.struct_size = 0; }), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(create_with([](BlobConfig& c) {
              c.struct_size = offsetof(mien_tracker_config, allocator) - 1;
            }),
            MIEN_ERROR_STRUCT_SIZE);
  // Fields beyond the end of an older struct are ignored.
  EXPECT_EQ(create_with([](BlobConfig& c) {
              c.struct_size = offsetof(mien_tracker_config, allocator);
              c.lod = 99;
            }),
            MIEN_OK);
  struct {
    mien_tracker_config config;
    unsigned char future[64];
  } longer = {config_, {1, 2, 3}};
  longer.config.struct_size = sizeof longer;
  mien_tracker* tracker = nullptr;
  ASSERT_EQ(mien_tracker_create(&longer.config, &tracker, nullptr), MIEN_OK);
  mien_tracker_destroy(tracker);
}

TEST_F(Create, AcceptsResultsOfOtherVersions) {
  Tracker tracker;
  ASSERT_EQ(tracker.create(config_), MIEN_OK);
  const Buffer disc(disc_picture(160.0f, 120.0f, 70.0f), {});
  ASSERT_EQ(tracker.push_video(disc.image(), 5), MIEN_OK);
  Result whole;
  ASSERT_EQ(tracker.get_result(whole), MIEN_OK);

  mien_result older;
  std::memset(&older, 0x5A, sizeof older);
  older.struct_size = offsetof(mien_result, controls);
  ASSERT_EQ(tracker.get_result(older), MIEN_OK);
  EXPECT_EQ(older.struct_size, offsetof(mien_result, controls));
  EXPECT_EQ(older.translation[2], whole.translation[2]);
  unsigned char untouched[sizeof(float)];
  std::memset(untouched, 0x5A, sizeof untouched);
  EXPECT_EQ(std::memcmp(older.controls, untouched, sizeof untouched), 0);

  struct {
    mien_result result;
    unsigned char future[50];
  } newer;
  std::memset(&newer, 0x5A, sizeof newer);
  newer.result.struct_size = sizeof(mien_result) + 40;
  ASSERT_EQ(mien_tracker_get_result(tracker.get(), &newer.result), MIEN_OK);
  EXPECT_EQ(newer.result.frames, 1u);
  EXPECT_EQ(newer.future[0], 0);
  EXPECT_EQ(newer.future[39], 0);
  EXPECT_EQ(newer.future[40], 0x5A);

  Result tiny;
  tiny.struct_size = 8;
  EXPECT_EQ(tracker.get_result(tiny), MIEN_ERROR_STRUCT_SIZE);
}

TEST_F(Create, WorksInTheCallersMemory) {
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t bytes = required_bytes(config_, status);
  ASSERT_EQ(status, MIEN_OK);
  std::vector<std::byte> storage(bytes + 128, std::byte{0xAA});
  const auto address = reinterpret_cast<std::uintptr_t>(storage.data());
  std::byte* memory = storage.data() + (64 - address % 64) % 64;
  mien_tracker* tracker = nullptr;
  EXPECT_EQ(mien_tracker_create_in(&config_, memory, bytes - 1, &tracker, nullptr),
            MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_EQ(mien_tracker_create_in(&config_, memory + 8, bytes, &tracker, nullptr),
            MIEN_ERROR_ALIGNMENT);
  EXPECT_EQ(tracker, nullptr);

  BlobTracker reference;
  {
    Tracker inside;
    ASSERT_EQ(inside.create_in(config_, {memory, bytes}), MIEN_OK);
    for (int i = 0; i < 5; ++i) {
      const Buffer disc(disc_picture(150.0f + static_cast<float>(i), 120.0f, 70.0f), {});
      Result result;
      ASSERT_EQ(inside.push_video(disc.image(), i * kFrameNs), MIEN_OK);
      ASSERT_EQ(inside.get_result(result), MIEN_OK);
      const Result other = reference.push(disc.image(), i * kFrameNs);
      EXPECT_EQ(std::memcmp(&result, &other, sizeof(mien_result)), 0);
    }
  }
  for (std::size_t i = 0; i < bytes; ++i) {
    ASSERT_EQ(memory[i], std::byte{0}) << "wiped at destroy";
  }
  EXPECT_EQ(memory[bytes], std::byte{0xAA});
}

TEST_F(Create, WorksManyTimes) {
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(create(), MIEN_OK);
  }
}

}  // namespace
}  // namespace mien::tests
