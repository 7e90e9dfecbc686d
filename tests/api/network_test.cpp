// Tests of custom networks through the C API, with the networks of apps/conformance/golden.
#include <gtest/gtest.h>
#include <mien/mien.hpp>

#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "tests/engine/mini_model.h"

extern "C" int mien_c_network(const void* file, size_t file_bytes, const float* image,
                              size_t image_bytes, float* features);

namespace mien::tests {
namespace {

class CNetwork : public testing::Test {
 protected:
  CNetwork() {
    const std::span<const std::byte> file = bytes.span();
    EXPECT_EQ(weights.create({&file, 1}), MIEN_OK);
    mien_network_config_default(&config);
    config.weights = weights.get();
  }
  ~CNetwork() override { mien_network_destroy(network); }

  mien_status create(const char* name) {
    mien_network_destroy(network);
    config.name = name;
    network = reinterpret_cast<mien_network*>(&config);  // must be overwritten
    return mien_network_create(&config, &network, &error);
  }

  AlignedBuffer bytes = mini_file();
  Weights weights;
  mien_network_config config;
  Error error;
  mien_network* network = nullptr;
};

TEST_F(CNetwork, RunsFromC) {
  const std::vector<float> image = golden("encoder_input"), want = golden("encoder_output");
  std::vector<float> features(want.size());
  ASSERT_EQ(mien_c_network(bytes.span().data(), bytes.span().size(), image.data(),
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
  EXPECT_STREQ(error.name, "nobody");
  config.height = 30;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_STREQ(error.field, "width");
  config.width = 30;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_WEIGHTS_SHAPE);
  EXPECT_EQ(error.message(),
            "network encoder, input height: a network or constant in the weight file has the wrong "
            "shape (got 27, expected 30)");
  config.height = config.width = 1 << 20;
  EXPECT_EQ(create("pnet"), MIEN_ERROR_TOO_LARGE);
  EXPECT_STREQ(error.name, "pnet");
  config.height = config.width = 0;
  config.cpu_mask = 0;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_UNSUPPORTED_LAYER);
  EXPECT_EQ(error.message(), "network encoder, layer 1: no allowed tier has a kernel for a layer");
  config.cpu_mask = MIEN_CPU_ALL;
  config.weights = nullptr;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_STREQ(error.field, "weights");
  config.struct_size = 8;
  EXPECT_EQ(create("encoder"), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(mien_network_create(nullptr, &network, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_network_create(&config, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  std::size_t needed = 1;
  EXPECT_EQ(mien_network_required_bytes(nullptr, &needed, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(needed, 0u);
  EXPECT_EQ(mien_network_required_bytes(&config, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST_F(CNetwork, KeepsItsWeights) {
  ASSERT_EQ(create("encoder"), MIEN_OK);
  weights = Weights();
  EXPECT_EQ(mien_network_run(network), MIEN_OK);
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
