// Runs networks of inverted residual blocks fused and layer by layer: all published networks, and
// random ones that are compared with plain layers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/fused_block.h"
#include "kernels/families.h"
#include "kernels/registry.h"
#include "tests/engine/twin_session.h"

namespace mien::tests {
namespace {

using Index = TwinNetwork::Index;
using Options = TwinNetwork::Options;
using formats::LayerActivation;

AlignedBuffer file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  return AlignedBuffer(std::as_bytes(std::span(bytes)));
}

void set_random(engine::Session& session, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> values(-1.0f, 1.0f);
  const auto channels = static_cast<std::size_t>(session.input_shape().c);
  const std::size_t pixels = session.input_shape().pixels();
  for (std::size_t i = 0; i < session.input().size(); ++i) {
    const bool used =
        session.input_shape().interleaved() || i / (8 * pixels) * 8 + i % 8 < channels;
    session.input()[i] = used ? values(random) : 0.0f;
  }
}

void expect_same(const engine::Session& a, const engine::Session& b, double tolerance) {
  for (std::uint32_t output = 0; output < a.output_count(); ++output) {
    double largest = 1e-3;
    for (const float one : a.output(output)) {
      largest = std::max(largest, std::abs(static_cast<double>(one)));
    }
    for (std::size_t i = 0; i < a.output(output).size(); ++i) {
      ASSERT_NEAR(a.output(output)[i], b.output(output)[i], tolerance * largest)
          << "output " << output << ", element " << i;
    }
  }
}

// CPU masks of the tiers that can fuse blocks; without kFusedBlocks, so that they run layer by
// layer.
std::vector<std::uint32_t> fusing_tiers() {
  std::vector<std::uint32_t> masks;
  for (const kernels::Entry& entry : kernels::all_kernels()) {
    if (entry.family == kernels::InvertedResidualArgs::kFamily &&
        (kernels::detect_cpu() & kernels::bit(entry.tier)) != 0) {
      masks.push_back(kernels::up_to(entry.tier));
    }
  }
  return masks;
}

TEST(FusedBlocks, PublishedNetworksGiveTheSameOutputs) {
  for (const auto& entry : std::filesystem::directory_iterator(MIEN_SOURCE_DIR "/models")) {
    if (entry.path().extension() != ".mien") {
      continue;
    }
    AlignedBuffer bytes = file_bytes(entry.path());
    engine::Model model;
    ASSERT_EQ(model.open(bytes.span()).status, MIEN_OK);
    for (const formats::NetworkRecord& network : model.file().networks()) {
      const std::string name(model.file().text(network.name));
      for (const std::uint32_t mask : fusing_tiers()) {
        OwnedSession plain(bytes, name, {}, mask);
        OwnedSession fused(bytes, name, {}, mask | kernels::kFusedBlocks);
        ASSERT_EQ(plain.status, MIEN_OK);
        ASSERT_EQ(fused.status, MIEN_OK);
        set_random(*plain.session, 1);
        set_random(*fused.session, 1);
        fused.fill_arena_with_nan();
        plain.session->run();
        fused.session->run();
        ASSERT_NO_FATAL_FAILURE(expect_same(*plain.session, *fused.session, twin_tolerance(mask)))
            << entry.path() << " " << name << ", tier mask " << mask;
      }
    }
  }
}

TEST(FusedBlocks, TakeFewerStepsAndLessMemory) {
  AlignedBuffer bytes = file_bytes(MIEN_SOURCE_DIR "/models/hifinet.mien");
  for (const std::uint32_t mask : fusing_tiers()) {
    const OwnedSession plain(bytes, "encoder", {}, mask);
    const OwnedSession fused(bytes, "encoder", {}, mask | kernels::kFusedBlocks);
    EXPECT_EQ(fused.session->step_count(), 15u);  // a convolution, 13 blocks and the tail
    EXPECT_LT(fused.session->step_count(), plain.session->step_count());
    EXPECT_LT(fused.size.arena_bytes, plain.size.arena_bytes);
  }
}

// Tiles of a 3 x 3 depthwise layer with one row and column of padding around the map.
engine::BlockTiling tiling_of(engine::Shape hidden, std::uint16_t stride) {
  formats::LayerRecord depthwise{};
  depthwise.kernel_height = depthwise.kernel_width = 3;
  depthwise.stride_height = depthwise.stride_width = stride;
  depthwise.pad_top = depthwise.pad_left = depthwise.pad_bottom = depthwise.pad_right = 1;
  const engine::Shape output = {(hidden.h - 1) / stride + 1, (hidden.w - 1) / stride + 1, hidden.c};
  return engine::tile_block(depthwise, hidden, output, 0);
}

TEST(FusedBlocks, TilesCoverSmallMapsAndFitTheCachesOtherwise) {
  const engine::BlockTiling whole = tiling_of({4, 4, 32}, 1);
  EXPECT_EQ(whole.band_rows, 4);
  EXPECT_EQ(whole.strip_rows, 6) << "no higher than the band needs";
  const engine::BlockTiling parts = tiling_of({56, 56, 96}, 2);
  EXPECT_EQ(parts.band_rows, 24);
  EXPECT_LE(parts.band_elems * sizeof(float), 256u * 1024);
  EXPECT_EQ(parts.strip_rows, 5);
  EXPECT_LE(parts.strip_elems * sizeof(float), 36u * 1024);
  EXPECT_EQ(tiling_of({2, 3, 96}, 1).strip_channels, 64);
  EXPECT_EQ(tiling_of({3, 3, 96}, 1).strip_channels, 48);
  EXPECT_EQ(tiling_of({2, 5, 96}, 1).strip_channels, 32);
}

TEST(FusedBlocks, EveryLayerIsInOneStep) {
  AlignedBuffer bytes = file_bytes(MIEN_SOURCE_DIR "/models/basenet.mien");
  const OwnedSession fused(bytes, "encoder", {});
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < fused.session->step_count(); ++i) {
    EXPECT_EQ(fused.session->step_layers(i).first, next);
    next += fused.session->step_layers(i).count;
  }
  EXPECT_EQ(next, 44u);
}

// Sums of this length exceed the precision of fixed point and fp16. Equal weights and equal inputs
// are the worst case of both: the scales of fixed point are largest, and a running sum in fp16
// stops growing.
TEST(FusedBlocks, LongSumsAreNotRoundedAway) {
  const auto same = [](std::uint32_t outputs, std::uint32_t inputs) {
    const std::size_t count = std::size_t{outputs} * inputs;
    return formats::Array{{outputs, inputs},
                          std::vector<float>(count, 3.0f / static_cast<float>(inputs))};
  };
  struct Sizes {
    std::uint32_t in_c, hidden_c;
  };
  for (const Sizes size : {Sizes{16384, 8}, Sizes{131072, 8}, Sizes{8, 16384}}) {
    formats::MienWriter writer;
    formats::NetworkWriter& net = writer.network("net", {1, 1, size.in_c});
    formats::LayerOptions relu6;
    relu6.activation = LayerActivation::kRelu6;
    const formats::Array ones{{size.hidden_c, 1, 1, 1}, std::vector<float>(size.hidden_c, 1.0f)};
    const formats::LayerIndex expanded = net.pointwise(0, same(size.hidden_c, size.in_c), {});
    const formats::LayerIndex filtered = net.depthwise(expanded, ones, {}, relu6);
    net.output(net.pointwise(filtered, same(8, size.hidden_c), {}));
    AlignedBuffer bytes = finished(writer);
    for (const std::uint32_t mask : fusing_tiers()) {
      OwnedSession fused(bytes, "net", {}, mask | kernels::kFusedBlocks);
      ASSERT_EQ(fused.status, MIEN_OK);
      EXPECT_EQ(fused.session->step_count(), 1u);
      std::fill(fused.session->input().begin(), fused.session->input().end(), 1.0f);
      fused.fill_arena_with_nan();
      fused.session->run();
      for (const float one : fused.session->output(0)) {
        EXPECT_NEAR(one, 9.0f, 9.0 * (is_half(mask) ? kHalfTwinTolerance : 1e-3))
            << size.in_c << " to " << size.hidden_c << ", tier mask " << mask;
      }
    }
  }
}

// Blocks as in published networks, and blocks that must not be fused: another layer reads their
// intermediate values, or an activation is not one of a fused block's.
class RandomBlocks {
 public:
  RandomBlocks(formats::NetworkWriter& writer, formats::InputShape input, unsigned seed)
      : twin(writer, input, seed), random_(seed) {
    Index x = twin.conv2d(0, between(1, 40), 3, 3, options(false));
    for (std::uint32_t i = between(1, 4); i > 0; --i) {
      x = add_block(x);
    }
    twin.output(x);
    if (inside_ != 0 && between(0, 2) == 0) {
      twin.output(inside_);
    }
  }

  TwinNetwork twin;

 private:
  std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random_);
  }

  Options options(bool any) {
    const LayerActivation kinds[] = {LayerActivation::kNone, LayerActivation::kRelu,
                                     LayerActivation::kRelu6, LayerActivation::kClamp01,
                                     LayerActivation::kTanh};
    Options options;
    options.activation = kinds[between(0, any ? 4 : 3)];
    return options;
  }

  Index add_block(Index x) {
    const Map& map = twin.value(x);
    const auto channels = static_cast<std::uint32_t>(map.c);
    if (map.h < 3 || map.w < 3) {
      return twin.pointwise(x, between(1, 40), options(true));
    }
    const bool adds = between(0, 1) == 0;
    const Index expanded =
        between(0, 3) == 0 ? x : twin.pointwise(x, between(1, 100), options(true));
    Options window_options = options(true);
    if (between(0, 1) == 0) {
      window_options.padding = {1, 1, 1, 1};
    }
    if (!adds && between(0, 1) == 0) {
      window_options.stride_x = window_options.stride_y = 2;
    }
    const Index filtered = twin.depthwise(expanded, 3, 3, window_options);
    inside_ = between(0, 1) == 0 ? expanded : filtered;
    const Index projected =
        twin.pointwise(filtered, adds ? channels : between(1, 60), options(true));
    return adds ? twin.add(projected, x) : projected;
  }

  std::mt19937 random_;
  Index inside_ = 0;  // an intermediate value, which a fused block does not store
};

// Register tiles have few sizes. For every number of pixels and of channel vectors there must be
// one that stays within the map.
TEST(FusedBlocks, FewPixelsAgreeWithPlainLayersAtEveryWidth) {
  for (std::uint32_t channels = 16; channels <= 144; channels += 8) {
    for (std::uint32_t pixels = 1; pixels <= 10; ++pixels) {
      const formats::InputShape input{1, pixels, 16};
      for (const std::uint32_t tier : tiers_here()) {
        formats::MienWriter writer;
        TwinNetwork twin(writer.network("net", input), input, channels + pixels);
        Options relu6;
        relu6.activation = LayerActivation::kRelu6;
        const Index expanded = twin.pointwise(0, channels, relu6);
        const Index depthwise = twin.depthwise(expanded, 1, 1, relu6);
        twin.output(twin.pointwise(depthwise, channels, {}));
        ASSERT_NO_FATAL_FAILURE(expect_twins_agree(writer, "net", twin, tier, 1))
            << channels << " channels, " << pixels << " pixels, tier mask " << tier;
      }
    }
  }
}

struct InputRange {
  float scale = 1.0f, largest = 1.0f;  // of magnitudes; larger ones are clamped
};

// Outputs of a fused block on every tier of this CPU among `tiers`.
std::vector<std::vector<float>> outputs_on(std::uint32_t tiers, const AlignedBuffer& bytes,
                                           unsigned seed, InputRange range = {}) {
  std::vector<std::vector<float>> outputs;
  for (const std::uint32_t mask : fusing_tiers()) {
    if ((mask & tiers) == 0) {
      continue;
    }
    OwnedSession fused(bytes, "net", {}, mask | kernels::kFusedBlocks);
    EXPECT_EQ(fused.status, MIEN_OK);
    EXPECT_EQ(fused.session->step_count(), 1u);
    set_random(*fused.session, seed);
    for (float& one : fused.session->input()) {
      one = std::clamp(range.scale * one, -range.largest, range.largest);
    }
    fused.fill_arena_with_nan();
    fused.session->run();
    outputs.emplace_back(fused.session->output(0).begin(), fused.session->output(0).end());
  }
  return outputs;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// A block whose expand and project layers have these input bounds.
AlignedBuffer block_with_bounds(unsigned seed, float expand_bound, float project_bound) {
  const formats::InputShape input{3 + seed % 7, 3 + seed % 5, 8 + 8 * (seed % 4)};
  formats::MienWriter writer;
  TwinNetwork twin(writer.network("net", input), input, seed);
  Options relu6, expand, project;
  relu6.activation = expand.activation = LayerActivation::kRelu6;
  expand.input_bound = expand_bound;
  project.input_bound = project_bound;
  const Index expanded = twin.pointwise(0, 8 + 7 * seed, expand);
  const Index filtered = twin.depthwise(expanded, 3, 3, relu6);
  twin.output(twin.pointwise(filtered, 8 + 5 * (seed % 9), project));
  return finished(writer);
}

// Integer sums are exact in any order, and all quantized tiers compute the rest in the same order.
TEST(FusedBlocks, QuantizedTiersGiveTheSameBits) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto expect_one_result = [&](std::uint32_t tiers, const AlignedBuffer& bytes) {
      const auto outputs = outputs_on(tiers, bytes, seed);
      for (const std::vector<float>& one : outputs) {
        EXPECT_TRUE(same_bits(one, outputs[0])) << "seed " << seed << ", tiers " << tiers;
      }
    };
    expect_one_result(kernels::kQuantizedTiers, block_with_bounds(seed, 0.0f, 0.0f));
    expect_one_result(kernels::kInt8Tiers,
                      block_with_bounds(seed, static_cast<float>(seed % 3), 2.0f));
  }
}

// Tiers without 8-bit products ignore input bounds.
TEST(FusedBlocks, InputBoundsOnlyAffectTiersWithEightBits) {
  const AlignedBuffer bounded = block_with_bounds(5, 1.0f, 6.0f);
  const AlignedBuffer unbounded = block_with_bounds(5, 0.0f, 0.0f);
  const auto differ = [&](std::uint32_t tiers) {
    const auto a = outputs_on(tiers, bounded, 5), b = outputs_on(tiers, unbounded, 5);
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      different += same_bits(a[i], b[i]) ? 0 : 1;
    }
    return std::pair(different, a.size());
  };
  EXPECT_EQ(differ(kernels::kHalfTiers & ~kernels::kInt8Tiers).first, 0u);
  const auto [different, tiers] = differ(kernels::kInt8Tiers);
  EXPECT_EQ(different, tiers) << "8 bits are not used";
}

// Inputs beyond the bound saturate: they give the same result as the bound.
TEST(FusedBlocks, InputsBeyondTheirBoundSaturate) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const AlignedBuffer bytes = block_with_bounds(seed, 0.5f, 0.0f);
    const auto inside = outputs_on(kernels::kInt8Tiers, bytes, seed, {1e30f, 0.5f});
    const auto beyond = outputs_on(kernels::kInt8Tiers, bytes, seed, {1e30f, 1e30f});
    for (std::size_t i = 0; i < inside.size(); ++i) {
      EXPECT_TRUE(same_bits(inside[i], beyond[i])) << "seed " << seed;
    }
  }
}

TEST(FusedBlocks, RandomNetworksAgreeWithPlainLayers) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const formats::InputShape input{9 + seed % 17, 9 + seed % 13, 1 + seed % 9};
    for (const std::uint32_t tier : tiers_here()) {
      formats::MienWriter writer;
      RandomBlocks network(writer.network("net", input), input, seed);
      ASSERT_NO_FATAL_FAILURE(expect_twins_agree(writer, "net", network.twin, tier, 1))
          << "seed " << seed << ", tier mask " << tier;
    }
  }
}

}  // namespace
}  // namespace mien::tests
