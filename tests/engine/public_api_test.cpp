// Tests include/mien/engine.h, as users include it.
#include <gtest/gtest.h>
#include <mien/engine.h>

#include <algorithm>
#include <cfenv>
#include <cstdlib>
#include <cstring>
#include <new>
#include <random>
#include <set>
#include <string>

#include "formats/mien_writer.h"
#include "tests/engine/mini_model.h"
#include "tests/engine/twin_session.h"

namespace mien::tests {
namespace {

Weights weights_of(std::span<const std::byte> file) {
  Weights weights;
  EXPECT_EQ(weights.create({&file, 1}, true), MIEN_OK);
  return weights;
}

class Engine : public testing::Test {
 protected:
  mien_status create(Network& network, const char* name) {
    return network.create(NetworkConfig(weights, name));
  }

  AlignedBuffer bytes = mini_file();
  Weights weights = weights_of(bytes.span());
  WeightsContent file{weights};
};

std::vector<float> run(Network& runner, const std::vector<float>& input) {
  std::copy(input.begin(), input.end(), runner.input().begin());
  runner.run();
  return {runner.output(0).begin(), runner.output(0).end()};
}

TEST_F(Engine, RunsANetworkInAFewLines) {
  Network runner;
  ASSERT_EQ(create(runner, "encoder"), MIEN_OK);
  EXPECT_EQ(runner.input_shape(), (TensorShape{27, 27, 3}));
  const std::vector<float> want = golden("encoder_output");
  const std::vector<float> got = run(runner, golden("encoder_input"));
  ASSERT_EQ(runner.output_count(), 1);
  EXPECT_EQ(runner.output_shape(0), (TensorShape{1, 1, 256}));
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    EXPECT_NEAR(got[i], want[i], 1e-3f);
  }
}

TEST_F(Engine, RunsStepByStepAsAtOnce) {
  for (const char* name : {"encoder", "temporal"}) {
    Network whole, steps;
    ASSERT_EQ(create(whole, name), MIEN_OK);
    ASSERT_EQ(create(steps, name), MIEN_OK);
    std::vector<float> input(whole.input().size());
    for (std::size_t i = 0; i < input.size(); ++i) {
      input[i] = static_cast<float>(i % 13) / 13.0f;
    }
    std::copy(input.begin(), input.end(), steps.input().begin());
    std::int32_t layers = 0;
    for (std::int32_t step = 0; step < steps.step_count(); ++step) {
      const Network::StepLayers run = steps.step_layers(step);
      EXPECT_EQ(run.first, layers);
      layers += run.count;
      steps.run_step(step);
    }
    const std::span<const float> output = steps.output(0);
    EXPECT_EQ(run(whole, input), std::vector<float>(output.begin(), output.end()));
  }
  Network network;
  ASSERT_EQ(create(network, "encoder"), MIEN_OK);
  for (const std::int32_t outside : {-1, network.step_count()}) {
    EXPECT_EQ(network.step_layers(outside).count, 0);
    EXPECT_EQ(mien_network_run_step(network.get(), outside), MIEN_ERROR_OUT_OF_RANGE);
  }
  EXPECT_EQ(mien_network_run_step(nullptr, 0), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_network_step_count(nullptr), 0);
}

#if defined(FE_UPWARD) && !defined(__EMSCRIPTEN__)
// A network quantizes weights when it is created.
TEST(EngineFloatMode, IsSetWhenANetworkIsCreated) {
  constexpr std::uint32_t kChannels = 64;
  constexpr std::size_t kWeights = std::size_t{kChannels} * kChannels;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> values(-0.5f, 0.5f);
  formats::Array mixing{{kChannels, kChannels}, std::vector<float>(kWeights)};
  std::generate(mixing.values.begin(), mixing.values.end(), [&] { return values(random); });
  const formats::Array window_options{{kChannels, 1, 3, 3},
                                      std::vector<float>(std::size_t{9} * kChannels, 0.11f)};
  formats::MienWriter writer;
  formats::NetworkWriter& net = writer.network("net", {4, 4, kChannels});
  formats::LayerOptions relu6;
  relu6.activation = formats::LayerActivation::kRelu6;
  net.output(net.pointwise(
      net.depthwise(net.pointwise(0, mixing, {}, relu6), window_options, {}, relu6), mixing, {}));
  const Weights weights = weights_of(finished(writer).span());
  NetworkConfig config(weights, "net");
  config.cpu_mask = MIEN_CPU_ALL;
  mien_status status = MIEN_ERROR_INTERNAL;
  AlignedBuffer memory(required_bytes(config, status));
  ASSERT_EQ(status, MIEN_OK);
  std::vector<float> input(std::size_t{4} * 4 * kChannels);
  std::generate(input.begin(), input.end(), [&] { return values(random); });
  Network usual;
  ASSERT_EQ(usual.create(config), MIEN_OK);
  const std::vector<float> want = run(usual, input);
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    Network own, lent;
    std::fesetround(rounding);
    const mien_status own_status = own.create(config);
    const mien_status lent_status = lent.create_in(config, memory.span());
    EXPECT_EQ(std::fegetround(), rounding);
    std::fesetround(FE_TONEAREST);
    ASSERT_EQ(own_status, MIEN_OK);
    ASSERT_EQ(lent_status, MIEN_OK);
    EXPECT_EQ(run(own, input), want);
    EXPECT_EQ(run(lent, input), want);
  }
#ifdef __GLIBC__
  Network runner;
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(FE_INEXACT | FE_UNDERFLOW);  // not all machines support traps
  status = runner.create(config);
  fedisableexcept(FE_ALL_EXCEPT);
  ASSERT_EQ(status, MIEN_OK);
  EXPECT_EQ(run(runner, input), want);
#endif
}
#endif

TEST_F(Engine, RunsInTheCallersMemory) {
  const NetworkConfig config(weights, "encoder");
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t needed = required_bytes(config, status);
  ASSERT_EQ(status, MIEN_OK);
  EXPECT_GT(needed, file.network(0).session_bytes + file.network(0).arena_bytes);
  AlignedBuffer memory(needed + 64);
  const std::vector<float> input = golden("encoder_input");
  Network own, lent;
  ASSERT_EQ(create(own, "encoder"), MIEN_OK);
  Error error;
  EXPECT_EQ(lent.create_in(config, memory.span().first(needed - 1), &error),
            MIEN_ERROR_MEMORY_TOO_SMALL);
  EXPECT_EQ(error.got, static_cast<double>(needed - 1));
  EXPECT_EQ(error.expected_min, static_cast<double>(needed));
  EXPECT_EQ(lent.create_in(config, memory.span().subspan(8)), MIEN_ERROR_ALIGNMENT);
  EXPECT_EQ(lent.create_in(config, {}), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_FALSE(lent);
  ASSERT_EQ(lent.create_in(config, memory.span().first(needed)), MIEN_OK);
  EXPECT_EQ(run(own, input), run(lent, input));
}

struct CountingAllocator {
  int allocations = 0, releases = 0;
  bool empty = false;
  std::set<void*> live;

  mien_allocator callbacks() {
    mien_allocator allocator = {};
    allocator.user = this;
    allocator.allocate = [](void* user, size_t size, size_t alignment) -> void* {
      auto& self = *static_cast<CountingAllocator*>(user);
      EXPECT_EQ(size % alignment, 0u);
      if (self.empty) {
        return nullptr;
      }
      ++self.allocations;
      return *self.live.insert(::operator new (size, std::align_val_t{alignment})).first;
    };
    allocator.release = [](void* user, void* memory) {
      auto& self = *static_cast<CountingAllocator*>(user);
      ++self.releases;
      EXPECT_EQ(self.live.erase(memory), 1u);
      ::operator delete (memory, std::align_val_t{MIEN_ALIGNMENT});
    };
    return allocator;
  }
};

TEST_F(Engine, AsksTheAllocatorOnceAndGivesEverythingBack) {
  CountingAllocator memory;
  NetworkConfig config(weights, "encoder");
  config.allocator = memory.callbacks();
  {
    Network runner;
    ASSERT_EQ(runner.create(config), MIEN_OK);
    EXPECT_EQ(memory.allocations, 1);
    config.name = "temporal";
    ASSERT_EQ(runner.create(config), MIEN_OK);  // replaces the first
    EXPECT_EQ(memory.releases, 1);
    runner.run();
    runner.reset();
    EXPECT_EQ(memory.allocations, 2);
  }
  EXPECT_EQ(memory.releases, 2);
  EXPECT_TRUE(memory.live.empty());
}

TEST_F(Engine, LeavesNothingAllocatedOnError) {
  CountingAllocator memory;
  NetworkConfig config(weights, "nobody");
  config.allocator = memory.callbacks();
  Network runner;
  EXPECT_EQ(runner.create(config), MIEN_ERROR_WEIGHTS_INCOMPLETE);
  config.name = "encoder";
  config.cpu_mask = 0;
  EXPECT_EQ(runner.create(config), MIEN_ERROR_UNSUPPORTED_LAYER);
  config.cpu_mask = MIEN_CPU_ALL;
  config.height = 26;
  config.width = 27;
  EXPECT_EQ(runner.create(config), MIEN_ERROR_WEIGHTS_SHAPE);
  config.name = "pnet";
  config.height = config.width = 1 << 20;
  EXPECT_EQ(runner.create(config), MIEN_ERROR_TOO_LARGE);
  config.height = config.width = 0;
  memory.empty = true;
  EXPECT_EQ(runner.create(config), MIEN_ERROR_OUT_OF_MEMORY);
  EXPECT_EQ(memory.allocations, memory.releases);
  EXPECT_TRUE(memory.live.empty());
}

TEST_F(Engine, DescribesTheFile) {
  ASSERT_EQ(file.network_count(), 3);
  std::uint64_t stored = 0;
  for (std::int32_t n = 0; n < file.network_count(); ++n) {
    const NetworkInfo network = file.network(n);
    LayerInfo last;
    std::uint64_t parameters = 0, macs = 0;
    for (std::int32_t i = 0; i < network.layers; ++i) {
      last = file.layer(n, i);
      parameters += last.parameters;
      macs += last.macs;
      EXPECT_LE(last.input, i);
      EXPECT_LE(last.second_input, i);
    }
    EXPECT_EQ(parameters, network.parameters);
    EXPECT_EQ(macs, network.macs);
    stored += network.weight_bytes;
  }
  EXPECT_LT(stored, bytes.span().size());
  const LayerInfo stem = file.layer(0, 0);
  EXPECT_STREQ(stem.op, "conv2d");
  EXPECT_STREQ(stem.activation, "relu6");
  EXPECT_EQ(TensorShape(stem.output), (TensorShape{13, 13, 16}));
  EXPECT_EQ(stem.parameters, 3u * 3 * 3 * 16 + 16);
  EXPECT_EQ(stem.macs, 3u * 3 * 3 * 16 * 13 * 13);
  ASSERT_EQ(file.metadata_count(), 1);
  EXPECT_STREQ(file.metadata(0).key, "name");
  EXPECT_EQ(file.metadata(0).text(), "mini");
  EXPECT_EQ(file.constant_count(), 0);
  EXPECT_STREQ(file.constant(0).name, "");
  NetworkInfo network;
  EXPECT_EQ(mien_weights_network(weights.get(), 3, &network), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_weights_network(weights.get(), -1, &network), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_weights_network(nullptr, 0, &network), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_weights_network(weights.get(), 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  network.struct_size = 0;
  EXPECT_EQ(mien_weights_network(weights.get(), 0, &network), MIEN_ERROR_STRUCT_SIZE);
  LayerInfo layer;
  EXPECT_EQ(mien_weights_layer(weights.get(), 0, file.network(0).layers, &layer),
            MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_weights_layer(weights.get(), 0, -1, &layer), MIEN_ERROR_OUT_OF_RANGE);
  MetadataInfo metadata;
  EXPECT_EQ(mien_weights_metadata(weights.get(), 1, &metadata), MIEN_ERROR_OUT_OF_RANGE);
  ConstantInfo constant;
  EXPECT_EQ(mien_weights_constant(weights.get(), 0, &constant), MIEN_ERROR_OUT_OF_RANGE);
}

}  // namespace
}  // namespace mien::tests
