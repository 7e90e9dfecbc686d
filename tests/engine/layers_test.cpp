// Compares every layer operation of the format, in a network of its own, with plain layers in
// double.
#include "tests/engine/twin_session.h"

namespace mien::tests {
namespace {

using formats::InputShape;
using formats::LayerActivation;
using Options = TwinNetwork::Options;

template <class Build>
void expect_layer(InputShape input, const Build& build) {
  for (const std::uint32_t tier : tiers_here()) {
    formats::MienWriter writer;
    TwinNetwork twin(writer.network("net", input), input, 5);
    twin.output(build(twin));
    ASSERT_NO_FATAL_FAILURE(expect_twins_agree(writer, "net", twin, tier))
        << "tier mask " << tier << ", input " << input.height << "x" << input.width << "x"
        << input.channels;
  }
}

Options strided(std::uint16_t stride_y, std::uint16_t stride_x, formats::Padding padding = {}) {
  Options options;
  options.stride_y = stride_y;
  options.stride_x = stride_x;
  options.padding = padding;
  return options;
}

Options activating(LayerActivation activation) {
  Options options;
  options.activation = activation;
  options.alpha = activation == LayerActivation::kLeakyRelu ? 0.125f : 0.0f;
  return options;
}

const LayerActivation kActivations[] = {LayerActivation::kRelu,      LayerActivation::kRelu6,
                                        LayerActivation::kLeakyRelu, LayerActivation::kPrelu,
                                        LayerActivation::kSigmoid,   LayerActivation::kTanh,
                                        LayerActivation::kClamp01};

TEST(Layers, Conv2dOnAnInterleavedImageAndOnBlocks) {
  for (const std::uint32_t channels : {1u, 3u, 4u, 5u, 8u, 19u}) {
    for (const Options& options :
         {strided(1, 1), strided(2, 2), strided(2, 1, {1, 2, 0, 1}), strided(1, 3, {2, 0, 1, 1})}) {
      expect_layer({9, 11, channels},
                   [&](TwinNetwork& net) { return net.conv2d(0, 13, 3, 3, options); });
    }
  }
}

TEST(Layers, Conv2dWithKernelsOfOtherSizes) {
  for (const auto& [h, w] : {std::pair{1u, 1u}, {1u, 4u}, {5u, 2u}, {7u, 7u}}) {
    expect_layer({8, 9, 3}, [h = h, w = w](TwinNetwork& net) { return net.conv2d(0, 24, h, w); });
  }
}

TEST(Layers, Depthwise) {
  for (const std::uint32_t channels : {5u, 8u, 21u}) {
    for (const Options& options :
         {strided(1, 1), strided(2, 2), strided(1, 1, {1, 1, 1, 1}), strided(2, 1, {0, 2, 1, 0})}) {
      for (const auto& [h, w] : {std::pair{3u, 3u}, {2u, 5u}, {3u, 2u}}) {
        if (options.padding.left < w) {
          expect_layer({7, 6, channels}, [&, h = h, w = w](TwinNetwork& net) {
            return net.depthwise(0, h, w, options);
          });
        }
      }
    }
  }
}

TEST(Layers, Pointwise) {
  for (const std::uint32_t outputs : {1u, 8u, 16u, 17u, 40u}) {
    expect_layer({5, 3, 13}, [&](TwinNetwork& net) { return net.pointwise(0, outputs); });
  }
}

TEST(Layers, PointwiseWithAResidualOfItsOwnSizeAndWithACentreSlice) {
  expect_layer({6, 5, 12}, [](TwinNetwork& net) {
    const auto x = net.pointwise(net.depthwise(0, 3, 3, strided(1, 1, {1, 1, 1, 1})), 12);
    return net.add(x, 0);
  });
  expect_layer({9, 8, 12}, [](TwinNetwork& net) {
    return net.add(net.pointwise(net.depthwise(0, 5, 3), 12, activating(LayerActivation::kRelu)),
                   0);
  });
}

TEST(Layers, AdditionsThatNoPointwiseLayerCanDo) {
  expect_layer({7, 7, 9}, [](TwinNetwork& net) { return net.add(net.depthwise(0, 3, 3), 0); });
  // The pointwise result is larger than the other summand, has another reader, is both summands, or
  // is an output.
  expect_layer({7, 7, 9}, [](TwinNetwork& net) {
    return net.add(net.depthwise(0, 3, 3), net.pointwise(0, 9));
  });
  expect_layer({7, 7, 9}, [](TwinNetwork& net) {
    const auto x = net.pointwise(0, 9);
    return net.add(net.add(x, 0), x);
  });
  expect_layer({7, 7, 9}, [](TwinNetwork& net) {
    const auto x = net.pointwise(0, 9);
    return net.add(x, x);
  });
  expect_layer({7, 7, 9}, [](TwinNetwork& net) {
    const auto x = net.pointwise(0, 9);
    net.output(x);
    return net.add(x, 0);
  });
}

TEST(Layers, FullyConnectedOnVectorsAndMaps) {
  for (const InputShape input : {InputShape{1, 1, 3}, {1, 1, 8}, {1, 1, 77}}) {
    expect_layer(input, [](TwinNetwork& net) { return net.fully_connected(0, 19); });
  }
  expect_layer({3, 2, 11}, [](TwinNetwork& net) { return net.fully_connected(0, 9); });
}

TEST(Layers, CausalConvolution) {
  for (const std::uint32_t inputs : {3u, 16u, 21u}) {
    expect_layer({1, 1, inputs}, [](TwinNetwork& net) { return net.causal_conv(0, 18); });
  }
}

TEST(Layers, Lstm) {
  for (const std::uint32_t inputs : {5u, 16u}) {
    for (const std::uint32_t hidden : {8u, 24u}) {
      expect_layer({1, 1, inputs}, [&](TwinNetwork& net) { return net.lstm(0, hidden); });
    }
  }
}

TEST(Layers, MaxPool) {
  for (const bool ceil_mode : {false, true}) {
    Options options = strided(2, 2);
    options.ceil_mode = ceil_mode;
    expect_layer({8, 7, 10}, [&](TwinNetwork& net) { return net.max_pool(0, 3, 3, options); });
    options.padding = {1, 0, 0, 1};
    expect_layer({8, 7, 10}, [&](TwinNetwork& net) { return net.max_pool(0, 2, 3, options); });
  }
}

TEST(Layers, ActivationsAlone) {
  for (const LayerActivation kind : kActivations) {
    expect_layer({3, 4, 11}, [&](TwinNetwork& net) { return net.activation(0, activating(kind)); });
  }
}

TEST(Layers, ActivationsInsideOthers) {
  for (const LayerActivation kind : kActivations) {
    const Options options = activating(kind);
    expect_layer({6, 5, 3}, [&](TwinNetwork& net) { return net.conv2d(0, 11, 3, 3, options); });
    expect_layer({6, 5, 11}, [&](TwinNetwork& net) { return net.depthwise(0, 3, 3, options); });
    expect_layer({6, 5, 11}, [&](TwinNetwork& net) { return net.pointwise(0, 21, options); });
    expect_layer({1, 1, 9}, [&](TwinNetwork& net) { return net.fully_connected(0, 21, options); });
    expect_layer({1, 1, 9}, [&](TwinNetwork& net) { return net.causal_conv(0, 21, options); });
  }
}

TEST(Layers, Softmax) {
  for (const std::uint32_t channels : {5u, 8u, 13u}) {
    expect_layer({3, 2, channels}, [](TwinNetwork& net) { return net.softmax(0); });
  }
}

TEST(Layers, GlobalAveragePool) {
  for (const InputShape input : {InputShape{5, 7, 11}, {1, 1, 8}, {30, 20, 5}}) {
    expect_layer(input, [](TwinNetwork& net) { return net.global_average_pool(0); });
  }
}

TEST(Layers, ConcatOfChannelsThatBeginAnywhere) {
  for (const std::uint32_t a : {1u, 7u, 8u, 9u, 20u}) {
    for (const std::uint32_t b : {1u, 8u, 13u}) {
      expect_layer({4, 3, 10}, [&](TwinNetwork& net) {
        return net.concat(net.pointwise(0, a), net.pointwise(0, b));
      });
    }
  }
  expect_layer({1, 1, 5}, [](TwinNetwork& net) { return net.concat(0, 0); });
}

TEST(Layers, SlicesOfRowsColumnsAndChannels) {
  for (const auto first : std::initializer_list<std::uint16_t>{0, 3, 8, 13}) {
    for (const std::uint32_t channels : {1u, 6u, 8u, 10u}) {
      expect_layer({6, 7, 24}, [&](TwinNetwork& net) {
        return net.slice(0, first, channels, strided(1, 1, {1, 0, 2, 3}));
      });
    }
  }
  expect_layer({1, 1, 12}, [](TwinNetwork& net) { return net.slice(0, 4, 8); });
}

TEST(Layers, CurvesThatNoOtherLayerHas) {
  for (const LayerActivation kind :
       {LayerActivation::kHardSwish, LayerActivation::kSwish, LayerActivation::kGelu,
        LayerActivation::kGeluTanh, LayerActivation::kErf, LayerActivation::kExp}) {
    for (const std::uint32_t channels : {5u, 8u, 19u}) {
      expect_layer({3, 4, channels},
                   [&](TwinNetwork& net) { return net.activation(0, activating(kind)); });
    }
  }
  expect_layer({3, 4, 11}, [](TwinNetwork& net) {
    return net.activation(net.multiply(0, 0), activating(LayerActivation::kSqrt));
  });
}

// The second operand is a map, one row, one column or one pixel, with all channels or one.
TEST(Layers, ProductsQuotientsAndSumsWithMapsThatAreBroadcast) {
  for (const InputShape b :
       {InputShape{6, 7, 11}, {1, 7, 11}, {6, 1, 11}, {1, 1, 11}, {6, 7, 1}, {1, 1, 1}}) {
    const auto second = [&](TwinNetwork& net) {
      const auto rows = static_cast<std::uint16_t>(b.height == 1 ? 5 : 0);
      const auto columns = static_cast<std::uint16_t>(b.width == 1 ? 6 : 0);
      const auto part = net.slice(0, 0, b.channels, strided(1, 1, {rows, columns, 0, 0}));
      return net.activation(part, activating(LayerActivation::kExp));  // not zero
    };
    expect_layer({6, 7, 11}, [&](TwinNetwork& net) { return net.multiply(0, second(net)); });
    expect_layer({6, 7, 11}, [&](TwinNetwork& net) { return net.divide(0, second(net)); });
    expect_layer({6, 7, 11}, [&](TwinNetwork& net) { return net.broadcast_add(0, second(net)); });
  }
}

TEST(Layers, MapsInAnotherSize) {
  using formats::ResizeGrid;
  using formats::ResizeSampling;
  for (const auto grid :
       {ResizeGrid::kHalfPixel, ResizeGrid::kAsymmetric, ResizeGrid::kAlignCorners}) {
    for (const auto sampling :
         {ResizeSampling::kRoundHalfDown, ResizeSampling::kRoundHalfUp, ResizeSampling::kFloor,
          ResizeSampling::kCeil, ResizeSampling::kBilinear}) {
      for (const auto& [h, w] : {std::pair{10u, 12u}, {7u, 13u}, {3u, 2u}, {1u, 1u}, {5u, 6u}}) {
        expect_layer({5, 6, 9}, [&, h = h, w = w](TwinNetwork& net) {
          return net.resize(0, h, w, grid, sampling);
        });
      }
    }
  }
}

TEST(Layers, RearrangementsInEveryOrder) {
  for (std::uint16_t order = 0; order < 6; ++order) {
    const auto read = static_cast<formats::ReadingOrder>(order);
    for (const InputShape shape : {InputShape{1, 1, 360}, {5, 6, 12}, {12, 30, 1}, {9, 2, 20}}) {
      expect_layer({6, 5, 12}, [&](TwinNetwork& net) { return net.rearrange(0, read, shape); });
    }
  }
}

TEST(Layers, NormalizationOfChannels) {
  for (const std::uint32_t channels : {5u, 8u, 19u, 40u}) {
    expect_layer({4, 3, channels}, [](TwinNetwork& net) { return net.normalize(0, 1e-5f); });
  }
}

TEST(Layers, FourteenOutputs) {
  for (const std::uint32_t tier : tiers_here()) {
    formats::MienWriter writer;
    TwinNetwork twin(writer.network("net", {3, 4, 9}), {3, 4, 9}, 5);
    for (std::uint32_t i = 0; i < formats::kMaxOutputs; ++i) {
      twin.output(twin.pointwise(0, i + 1));
    }
    ASSERT_NO_FATAL_FAILURE(expect_twins_agree(writer, "net", twin, tier));
  }
}

}  // namespace
}  // namespace mien::tests
