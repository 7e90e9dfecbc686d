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

class Engine : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(file.open(bytes.span()), EngineStatus::kOk); }

  AlignedBuffer bytes = mini_file();
  WeightFile file;
};

std::vector<float> run(NetworkRunner& runner, const std::vector<float>& input) {
  std::copy(input.begin(), input.end(), runner.input().begin());
  runner.run();
  return {runner.output(0).begin(), runner.output(0).end()};
}

TEST_F(Engine, RunsANetworkInAFewLines) {
  NetworkRunner runner;
  ASSERT_EQ(runner.create(file, "encoder"), EngineStatus::kOk);
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
    NetworkRunner whole, steps;
    ASSERT_EQ(whole.create(file, name), EngineStatus::kOk);
    ASSERT_EQ(steps.create(file, name), EngineStatus::kOk);
    std::vector<float> input(whole.input().size());
    for (std::size_t i = 0; i < input.size(); ++i) {
      input[i] = static_cast<float>(i % 13) / 13.0f;
    }
    std::copy(input.begin(), input.end(), steps.input().begin());
    std::int32_t layers = 0;
    for (std::int32_t step = 0; step < steps.step_count(); ++step) {
      const NetworkRunner::StepLayers run = steps.step_layers(step);
      EXPECT_EQ(run.first, layers);
      layers += run.count;
      steps.run_step(step);
    }
    const std::span<const float> output = steps.output(0);
    EXPECT_EQ(run(whole, input), std::vector<float>(output.begin(), output.end()));
  }
  EXPECT_GT(run_fma_loop(~0u, 10), 0);
  EXPECT_EQ(run_fma_loop(0, 10), 0) << "no tier, no loop";
}

#if defined(FE_UPWARD) && !defined(__EMSCRIPTEN__)
// A runner quantizes weights when it is created.
TEST(EngineFloatMode, IsSetWhenARunnerIsCreated) {
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
  AlignedBuffer bytes = finished(writer);
  WeightFile file;
  ASSERT_EQ(file.open(bytes.span()), EngineStatus::kOk);
  NetworkRunner::Options options;
  options.cpu_mask = MIEN_CPU_ALL;
  RunnerMemory needed;
  ASSERT_EQ(NetworkRunner::required_memory(file, "net", options, needed), EngineStatus::kOk);
  AlignedBuffer session(needed.session), arena(needed.arena);
  std::vector<float> input(std::size_t{4} * 4 * kChannels);
  std::generate(input.begin(), input.end(), [&] { return values(random); });
  NetworkRunner usual;
  ASSERT_EQ(usual.create(file, "net", options), EngineStatus::kOk);
  const std::vector<float> want = run(usual, input);
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    NetworkRunner own, lent;
    std::fesetround(rounding);
    const EngineStatus own_status = own.create(file, "net", options);
    const EngineStatus lent_status =
        lent.create_in(file, "net", options, session.span(), arena.span());
    EXPECT_EQ(std::fegetround(), rounding);
    std::fesetround(FE_TONEAREST);
    ASSERT_EQ(own_status, EngineStatus::kOk);
    ASSERT_EQ(lent_status, EngineStatus::kOk);
    EXPECT_EQ(run(own, input), want);
    EXPECT_EQ(run(lent, input), want);
  }
#ifdef __GLIBC__
  NetworkRunner runner;
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(FE_INEXACT | FE_UNDERFLOW);  // not all machines support traps
  const EngineStatus status = runner.create(file, "net", options);
  const std::int64_t macs = run_fma_loop(~0u, 10);
  fedisableexcept(FE_ALL_EXCEPT);
  ASSERT_EQ(status, EngineStatus::kOk);
  EXPECT_GT(macs, 0);
  EXPECT_EQ(run(runner, input), want);
#endif
}
#endif

TEST_F(Engine, RunsInTheCallersMemory) {
  RunnerMemory needed;
  const NetworkRunner::Options options;
  ASSERT_EQ(NetworkRunner::required_memory(file, "encoder", options, needed), EngineStatus::kOk);
  EXPECT_EQ(needed.session, file.network(0).session_bytes);
  EXPECT_EQ(needed.arena, file.network(0).arena_bytes);
  AlignedBuffer session(needed.session), arena(needed.arena);
  NetworkRunner own, lent;
  ASSERT_EQ(own.create(file, "encoder"), EngineStatus::kOk);
  EXPECT_EQ(lent.create_in(file, "encoder", options, session.span().first(needed.session - 1),
                           arena.span()),
            EngineStatus::kMemoryTooSmall);
  EXPECT_EQ(lent.create_in(file, "encoder", options, session.span(),
                           arena.span().first(needed.arena - 1)),
            EngineStatus::kMemoryTooSmall);
  ASSERT_EQ(lent.create_in(file, "encoder", options, session.span(), arena.span()),
            EngineStatus::kOk);
  const std::vector<float> input = golden("encoder_input");
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
  NetworkRunner::Options options;
  options.allocator = memory.callbacks();
  {
    NetworkRunner runner;
    ASSERT_EQ(runner.create(file, "encoder", options), EngineStatus::kOk);
    EXPECT_EQ(memory.allocations, 1);
    ASSERT_EQ(runner.create(file, "temporal", options), EngineStatus::kOk);  // replaces the first
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
  NetworkRunner::Options options;
  options.allocator = memory.callbacks();
  NetworkRunner runner;
  EXPECT_EQ(runner.create(file, "nobody", options), EngineStatus::kNoSuchNetwork);
  options.cpu_mask = 0;
  EXPECT_EQ(runner.create(file, "encoder", options), EngineStatus::kNoKernel);
  options.cpu_mask = MIEN_CPU_ALL;
  options.input = {26, 27, 3};
  EXPECT_EQ(runner.create(file, "encoder", options), EngineStatus::kWrongInput);
  options.input = {1 << 20, 1 << 20, 3};
  EXPECT_EQ(runner.create(file, "pnet", options), EngineStatus::kTooLarge);
  options.input = {};
  memory.empty = true;
  EXPECT_EQ(runner.create(file, "encoder", options), EngineStatus::kOutOfMemory);
  EXPECT_EQ(memory.allocations, memory.releases);
  EXPECT_TRUE(memory.live.empty());
}

TEST_F(Engine, DescribesTheFile) {
  ASSERT_EQ(file.network_count(), 3);
  EXPECT_EQ(file.file_bytes(), bytes.span().size());
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
  EXPECT_LT(stored, file.file_bytes());
  const LayerInfo stem = file.layer(0, 0);
  EXPECT_STREQ(stem.op, "conv2d");
  EXPECT_STREQ(stem.activation, "relu6");
  EXPECT_EQ(stem.output, (TensorShape{13, 13, 16}));
  EXPECT_EQ(stem.parameters, 3u * 3 * 3 * 16 + 16);
  EXPECT_EQ(stem.macs, 3u * 3 * 3 * 16 * 13 * 13);
  ASSERT_EQ(file.metadata_count(), 1);
  EXPECT_EQ(file.metadata(0).key, "name");
  EXPECT_EQ(file.metadata(0).value, "mini");
  EXPECT_EQ(file.constant_count(), 0);
  EXPECT_EQ(file.constant(0).name, "");
}

TEST_F(Engine, TellsWhereAFileIsBroken) {
  bytes.span()[8] = std::byte{9};  // the major version
  EXPECT_EQ(file.open(bytes.span()), EngineStatus::kBadFile);
  EXPECT_STREQ(file.fault(), "unsupported version of the format");
  EXPECT_EQ(file.fault_offset(), 8u);
  EXPECT_EQ(file.network_count(), 0);
  EXPECT_EQ(file.open(bytes.span().subspan(8)), EngineStatus::kBadFile);
}

TEST(EngineStatus, HasAMessageEach) {
  std::set<std::string> messages;
  for (std::int32_t i = 0; i <= static_cast<std::int32_t>(EngineStatus::kOutOfMemory); ++i) {
    messages.insert(message(static_cast<EngineStatus>(i)));
  }
  EXPECT_EQ(messages.size(), 11u);
  EXPECT_EQ(messages.count(""), 0u);
  EXPECT_EQ(messages.count(message(static_cast<EngineStatus>(99))), 0u);
}

}  // namespace
}  // namespace mien::tests
