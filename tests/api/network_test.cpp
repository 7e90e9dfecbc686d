// Tests of custom networks through the C API, with the networks of apps/conformance/golden.
#include <gtest/gtest.h>
#include <mien/mien.h>

#include <cstdlib>
#include <vector>

#include "tests/engine/mini_model.h"

extern "C" int mien_c_network(const void* file, size_t file_bytes, const float* image,
                              size_t image_bytes, float* features);

namespace mien::tests {
namespace {

class CNetwork : public testing::Test {
 protected:
  CNetwork() {
    mien_network_config_default(&config);
    config.file = bytes.span().data();
    config.file_bytes = bytes.span().size();
  }
  ~CNetwork() override { mien_network_destroy(network); }

  mien_status create(const char* name) {
    mien_network_destroy(network);
    config.name = name;
    network = reinterpret_cast<mien_network*>(&config);  // must be overwritten
    return mien_network_create(&config, &network);
  }

  AlignedBuffer bytes = mini_file();
  mien_network_config config;
  mien_network* network = nullptr;
};

TEST_F(CNetwork, RunsFromC) {
  const std::vector<float> image = golden("encoder_input"), want = golden("encoder_output");
  std::vector<float> features(want.size());
  ASSERT_EQ(mien_c_network(config.file, config.file_bytes, image.data(),
                           image.size() * sizeof(float), features.data()),
            0);
  for (std::size_t i = 0; i < want.size(); ++i) {
    EXPECT_NEAR(features[i], want[i], 1e-3f);
  }
}

TEST_F(CNetwork, DefaultsToTheFirstNetwork) {
  ASSERT_EQ(create(nullptr), MIEN_OK);
  mien_shape shape{};
  EXPECT_NE(mien_network_input(network, &shape), nullptr);
  EXPECT_EQ(shape.height, 27);
  EXPECT_EQ(shape.channels, 3);
}

TEST_F(CNetwork, RunsOnLargerMaps) {
  config.height = 20;
  config.width = 31;
  ASSERT_EQ(create("pnet"), MIEN_OK);
  EXPECT_EQ(mien_network_output_count(network), 2);
  EXPECT_EQ(mien_network_run(network), MIEN_OK);
  mien_shape shape{};
  EXPECT_NE(mien_network_output(network, 1, &shape), nullptr);
  EXPECT_GT(shape.width, shape.height);
  EXPECT_EQ(mien_network_output(network, 2, &shape), nullptr);
  EXPECT_EQ(mien_network_output(network, -1, &shape), nullptr);
}

TEST_F(CNetwork, KeepsStateUntilReset) {
  ASSERT_EQ(create("temporal"), MIEN_OK);
  const std::vector<float> inputs = golden("temporal_input");
  const auto step = [&] {
    std::copy_n(inputs.begin(), 12, mien_network_input(network, nullptr));
    EXPECT_EQ(mien_network_run(network), MIEN_OK);
    const float* y = mien_network_output(network, 0, nullptr);
    return std::vector<float>(y, y + 10);
  };
  const std::vector<float> first = step();
  EXPECT_NE(step(), first);
  mien_network_reset(network);
  EXPECT_EQ(step(), first);
}

TEST_F(CNetwork, ExcludesHalfPrecisionByDefault) {
  mien_network_config fresh;
  mien_network_config_default(&fresh);
  EXPECT_EQ(fresh.cpu_mask, MIEN_CPU_ALL & ~MIEN_CPU_HALF);
}

TEST_F(CNetwork, ReportsErrors) {
  EXPECT_EQ(create("nobody"), MIEN_ERROR_WEIGHTS_INCOMPLETE);
  EXPECT_EQ(network, nullptr);
  config.height = 30;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_OUT_OF_RANGE);
  config.width = 30;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_WEIGHTS_SHAPE);
  config.height = config.width = 1 << 20;
  EXPECT_EQ(create("pnet"), MIEN_ERROR_OUT_OF_MEMORY);
  config.height = config.width = 0;
  config.cpu_mask = 0;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_UNSUPPORTED_LAYER);
  config.cpu_mask = MIEN_CPU_ALL;
  config.file_bytes -= 64;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_WEIGHTS_TRUNCATED);
  config.file_bytes += 64;
  config.file = bytes.span().data() + 8;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_ALIGNMENT);
  config.file = nullptr;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_NULL_ARGUMENT);
  config.struct_size = 8;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(mien_network_create(nullptr, &network), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_network_create(&config, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST_F(CNetwork, AcceptsNull) {
  mien_network_config_default(nullptr);
  mien_network_destroy(nullptr);
  mien_network_reset(nullptr);
  EXPECT_EQ(mien_network_input(nullptr, nullptr), nullptr);
  EXPECT_EQ(mien_network_run(nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_network_output_count(nullptr), 0);
  EXPECT_EQ(mien_network_output(nullptr, 0, nullptr), nullptr);
}

TEST_F(CNetwork, AllocatesOnceAndReleases) {
  struct Counts {
    int allocations = 0, releases = 0;
    bool empty = false;
  } counts;
  config.allocator.user = &counts;
  config.allocator.allocate = [](void* user, size_t size, size_t alignment) -> void* {
    auto& mine = *static_cast<Counts*>(user);
    ++mine.allocations;
    return mine.empty ? nullptr : std::aligned_alloc(alignment, (size + 63) / 64 * 64);
  };
  EXPECT_EQ(create("encoder"), MIEN_ERROR_OUT_OF_RANGE);  // one callback of two
  config.allocator.release = [](void* user, void* memory) {
    ++static_cast<Counts*>(user)->releases;
    std::free(memory);
  };
  ASSERT_EQ(create("encoder"), MIEN_OK);
  EXPECT_EQ(mien_network_run(network), MIEN_OK);
  mien_network_destroy(network);
  network = nullptr;
  EXPECT_EQ(counts.allocations, 1);
  EXPECT_EQ(counts.releases, 1);
  counts.empty = true;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_OUT_OF_MEMORY);
}

}  // namespace
}  // namespace mien::tests
