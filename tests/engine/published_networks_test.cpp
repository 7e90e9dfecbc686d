// The two image encoders have the published size: their multiply-accumulates match table 3 of
// Navarro et al. 2023 to 1 %. The exact counts follow from the architecture.
#include <gtest/gtest.h>
#include <mien/engine.h>

#include "tests/engine/owned_session.h"
#include "tests/engine/twin_network.h"

namespace mien::tests {
namespace {

using Index = TwinNetwork::Index;
using Options = TwinNetwork::Options;

struct Block {
  std::uint32_t expansion;
  std::uint16_t stride;
  bool padded, residual;
  std::uint32_t channels;
};

struct Encoder {
  formats::InputShape input;
  std::vector<Block> blocks;
  std::uint32_t tail_kernel_h, tail_kernel_w;
};

const Encoder kBaseNet{{65, 65, 3},
                       {{2, 2, false, false, 16},
                        {2, 1, false, true, 16},
                        {2, 1, false, true, 16},
                        {3, 2, false, false, 40},
                        {3, 1, true, true, 40},
                        {4, 2, true, false, 72},
                        {4, 1, true, true, 72},
                        {4, 1, true, true, 72},
                        {4, 1, true, true, 72},
                        {4, 1, true, true, 72},
                        {4, 1, true, false, 112}},
                       3,
                       3};

const Encoder kHiFiNet{{129, 109, 3},
                       {{1, 1, false, true, 16},
                        {4, 2, false, false, 24},
                        {4, 1, false, true, 24},
                        {4, 2, false, false, 40},
                        {4, 1, false, true, 40},
                        {4, 1, false, true, 40},
                        {4, 2, true, false, 96},
                        {4, 1, true, true, 96},
                        {4, 1, true, true, 96},
                        {4, 1, true, true, 96},
                        {4, 1, false, false, 128},
                        {4, 1, true, true, 128},
                        {4, 1, true, true, 128}},
                       3,
                       2};

Options relu6(std::uint16_t stride = 1, bool padded = false) {
  Options options;
  options.activation = formats::LayerActivation::kRelu6;
  options.stride_x = options.stride_y = stride;
  options.padding = padded ? formats::Padding{1, 1, 1, 1} : formats::Padding{};
  return options;
}

Index add_block(TwinNetwork& net, Index x, const Block& block) {
  const auto channels = static_cast<std::uint32_t>(net.value(x).c);
  const Index expanded =
      block.expansion == 1 ? x : net.pointwise(x, channels * block.expansion, relu6());
  const Index filtered = net.depthwise(expanded, 3, 3, relu6(block.stride, block.padded));
  const Index projected = net.pointwise(filtered, block.channels);
  return block.residual ? net.add(projected, x) : projected;
}

NetworkInfo info_of(const Encoder& encoder) {
  formats::MienWriter writer;
  TwinNetwork net(writer.network("encoder", encoder.input), encoder.input, 1);
  Index x = net.conv2d(0, 16, 3, 3, relu6(2));
  for (const Block& block : encoder.blocks) {
    x = add_block(net, x, block);
  }
  x = net.pointwise(x, static_cast<std::uint32_t>(net.value(x).c) * 6, relu6());
  x = net.depthwise(x, encoder.tail_kernel_h, encoder.tail_kernel_w, relu6());
  net.output(net.pointwise(x, 256));
  std::vector<std::byte> bytes;
  EXPECT_EQ(writer.finish(&bytes).status, MIEN_OK);
  const std::span<const std::byte> file = bytes;
  Weights weights;
  EXPECT_EQ(weights.create({&file, 1}, true), MIEN_OK);
  return WeightsContent(weights).network(0);
}

TEST(PublishedNetworks, BaseNetEncoder) {
  const NetworkInfo info = info_of(kBaseNet);
  EXPECT_EQ(info.parameters, 528656u);
  EXPECT_EQ(info.macs, 5217768u);
  EXPECT_NEAR(static_cast<double>(info.macs), 5.23e6, 0.01 * 5.23e6);
  EXPECT_EQ(info.weight_bytes, 2 * info.parameters);  // every channel count is a multiple of 8
}

TEST(PublishedNetworks, HiFiNetEncoder) {
  const NetworkInfo info = info_of(kHiFiNet);
  EXPECT_EQ(info.parameters, 969400u);
  EXPECT_EQ(info.macs, 25253856u);
  EXPECT_NEAR(static_cast<double>(info.macs), 25.22e6, 0.01 * 25.22e6);
  EXPECT_EQ(info.weight_bytes, 2 * info.parameters);
}

}  // namespace
}  // namespace mien::tests
