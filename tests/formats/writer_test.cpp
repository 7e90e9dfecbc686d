// Tests of weight packing, and of inputs that the writer rejects.
#include "formats/mien_writer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

#include "formats/fp16.h"
#include "tests/formats/files.h"

namespace mien::formats {
namespace {

// 1, 2, 3, ...: exact in fp16 up to 2048, and all different.
Array counting(std::vector<std::uint32_t> shape) {
  Array array{std::move(shape), {}};
  std::size_t count = 1;
  for (const std::uint32_t dim : array.shape) {
    count *= dim;
  }
  array.values.resize(count);
  std::iota(array.values.begin(), array.values.end(), 1.0f);
  return array;
}

// A file with one network whose tensors are given as floats.
class Written {
 public:
  Written(InputShape input, const std::function<LayerIndex(NetworkWriter&)>& build) {
    MienWriter writer;
    NetworkWriter& net = writer.network("net", input);
    net.output(build(net));
    std::vector<std::byte> file;
    EXPECT_EQ(status_name(writer.finish(&file).status), "kOk");
    bytes_.emplace(file);
    EXPECT_EQ(open(bytes_->get(), view_).status, MIEN_OK);
  }

  std::vector<float> tensor(std::size_t index) const {
    const auto data = view_.data(view_.tensors()[index]);
    std::vector<float> values(data.size() / 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::uint16_t half = 0;
      std::memcpy(&half, data.data() + 2 * i, 2);
      values[i] = float_from_fp16(half);
    }
    return values;
  }

 private:
  std::optional<AlignedBytes> bytes_;
  FileView view_;
};

// Element of a panel-packed tensor: output o, step k of K, outputs padded to `padded`.
float in_panels(const std::vector<float>& packed, std::size_t padded, std::size_t steps,
                std::size_t o, std::size_t k) {
  const std::size_t panel = o / 16;
  const std::size_t width = std::min<std::size_t>(16, padded - 16 * panel);
  return packed.at(panel * 16 * steps + k * width + o % 16);
}

TEST(Packing, Conv2dPanelsRunOverRowColumnChannel) {
  const Array weight = counting({20, 3, 2, 3});
  const Written file({4, 4, 3}, [&](NetworkWriter& net) { return net.conv2d(0, weight, {}); });
  const auto packed = file.tensor(0);
  ASSERT_EQ(packed.size(), 24u * 18);
  for (std::size_t o = 0; o < 24; ++o) {
    for (std::size_t y = 0; y < 2; ++y) {
      for (std::size_t x = 0; x < 3; ++x) {
        for (std::size_t i = 0; i < 3; ++i) {
          const float wanted = o < 20 ? weight.values[((o * 3 + i) * 2 + y) * 3 + x] : 0.0f;
          EXPECT_EQ(in_panels(packed, 24, 18, o, (y * 3 + x) * 3 + i), wanted);
        }
      }
    }
  }
  EXPECT_EQ(file.tensor(1), std::vector<float>(24, 0.0f));
}

TEST(Packing, PointwisePadsInputsAndOutputs) {
  const Array weight = counting({5, 11});
  const Written file({2, 3, 11}, [&](NetworkWriter& net) {
    return net.pointwise(0, weight, {1, 2, 3, 4, 5});
  });
  const auto packed = file.tensor(0);
  ASSERT_EQ(packed.size(), 8u * 16);
  for (std::size_t o = 0; o < 8; ++o) {
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_EQ(in_panels(packed, 8, 16, o, i), o < 5 && i < 11 ? weight.values[o * 11 + i] : 0.0f);
    }
  }
  EXPECT_EQ(file.tensor(1), (std::vector<float>{1, 2, 3, 4, 5, 0, 0, 0}));
}

TEST(Packing, FullyConnectedFollowsTheBlocksOfTheMap) {
  const Array weight = counting({2, 10 * 2 * 3});
  const Written file({2, 3, 10},
                     [&](NetworkWriter& net) { return net.fully_connected(0, weight, {}); });
  const auto packed = file.tensor(0);
  ASSERT_EQ(packed.size(), 8u * 16 * 6);
  for (std::size_t o = 0; o < 2; ++o) {
    for (std::size_t c = 0; c < 16; ++c) {
      for (std::size_t pixel = 0; pixel < 6; ++pixel) {
        const float wanted = c < 10 ? weight.values[(o * 10 + c) * 6 + pixel] : 0.0f;
        EXPECT_EQ(in_panels(packed, 8, 96, o, (c / 8 * 6 + pixel) * 8 + c % 8), wanted);
      }
    }
  }
}

TEST(Packing, CausalConvReadsThePreviousInputFirst) {
  const Array weight = counting({3, 5, 2});
  const Written file({1, 1, 5}, [&](NetworkWriter& net) { return net.causal_conv(0, weight, {}); });
  const auto packed = file.tensor(0);
  for (std::size_t o = 0; o < 3; ++o) {
    for (std::size_t k = 0; k < 16; ++k) {
      const float wanted = k % 8 < 5 ? weight.values[(o * 5 + k % 8) * 2 + k / 8] : 0.0f;
      EXPECT_EQ(in_panels(packed, 8, 16, o, k), wanted);
    }
  }
}

TEST(Packing, LstmConcatenatesInputAndState) {
  const Array ih = counting({32, 3});
  Array hh = counting({32, 8});
  for (float& value : hh.values) {
    value += 1000;
  }
  const Written file({1, 1, 3}, [&](NetworkWriter& net) { return net.lstm(0, ih, hh, {}); });
  const auto packed = file.tensor(0);
  ASSERT_EQ(packed.size(), 32u * 16);
  for (std::size_t o = 0; o < 32; ++o) {
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_EQ(in_panels(packed, 32, 16, o, k), k < 3 ? ih.values[o * 3 + k] : 0.0f);
      EXPECT_EQ(in_panels(packed, 32, 16, o, 8 + k), hh.values[o * 8 + k]);
    }
  }
  EXPECT_EQ(file.tensor(1).size(), 32u);
}

TEST(Packing, DepthwiseKeepsBlocksOfEight) {
  const Array weight = counting({10, 1, 2, 2});
  const Written file({2, 2, 10}, [&](NetworkWriter& net) { return net.depthwise(0, weight, {}); });
  const auto packed = file.tensor(0);
  ASSERT_EQ(packed.size(), 16u * 4);
  for (std::size_t c = 0; c < 16; ++c) {
    for (std::size_t tap = 0; tap < 4; ++tap) {
      EXPECT_EQ(packed[(c / 8 * 4 + tap) * 8 + c % 8], c < 10 ? weight.values[c * 4 + tap] : 0.0f);
    }
  }
}

mien_status status_of(InputShape input, const std::function<void(NetworkWriter&)>& build,
                      bool any_size = false) {
  MienWriter writer;
  build(writer.network("net", input, any_size));
  std::vector<std::byte> file(3);
  const mien_error_detail validation = writer.finish(&file);
  EXPECT_EQ(file.empty(), validation.status != MIEN_OK);
  return static_cast<mien_status>(validation.status);
}

using Net = NetworkWriter;

constexpr InputShape kMap = {4, 4, 8};

TEST(Writer, RejectsInvalidLayersWithWeights) {
  LayerOptions padded;
  padded.padding = {3, 0, 0, 0};
  LayerOptions prelu;
  prelu.activation = LayerActivation::kPrelu;
  const auto conv = [](Net& n, const LayerOptions& options) {
    n.output(n.conv2d(0, counting({8, 8, 3, 3}), {}, options));
  };
  EXPECT_EQ(status_of(kMap, [&](Net& n) { conv(n, {}); }), MIEN_OK);
  EXPECT_EQ(status_of(kMap, [&](Net& n) { conv(n, padded); }), MIEN_ERROR_WEIGHTS_LAYER_WINDOW);
  EXPECT_EQ(status_of(kMap, [&](Net& n) { conv(n, prelu); }), MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  EXPECT_EQ(status_of({2, 2, 8}, [&](Net& n) { conv(n, {}); }), MIEN_ERROR_WEIGHTS_LAYER_SHAPE);
  EXPECT_EQ(status_of({4, 4, 7}, [&](Net& n) { conv(n, {}); }), MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  EXPECT_EQ(status_of({0, 4, 8}, [&](Net& n) { conv(n, {}); }), MIEN_ERROR_WEIGHTS_NETWORK);
  EXPECT_EQ(status_of(kMap,
                      [&](Net& n) {
                        n.output(n.pointwise(0, counting({3, 8}), {1, 2}));
                      }),
            MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  EXPECT_EQ(status_of(kMap,
                      [&](Net& n) {
                        n.output(n.pointwise(0, Array{{3, 8}, {1}}, {}));
                      }),
            MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  EXPECT_EQ(status_of(kMap,
                      [&](Net& n) {
                        n.output(n.pointwise(0, Array{{3, 8}, std::vector<float>(25)}, {}));
                      }),
            MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.pointwise(0, Array{}, {})); }),
            MIEN_ERROR_WEIGHTS_LAYER_TENSORS);
  EXPECT_EQ(status_of(kMap,
                      [&](Net& n) {
                        n.output(n.causal_conv(0, counting({8, 8, 2}), {}));
                      }),
            MIEN_ERROR_WEIGHTS_LAYER_SHAPE);
  EXPECT_EQ(status_of(
                kMap,
                [&](Net& n) {
                  n.output(n.fully_connected(0, counting({2, 128}), {}));
                },
                true),
            MIEN_ERROR_WEIGHTS_LAYER_OP);
}

TEST(Writer, RejectsInvalidWindows) {
  LayerOptions sparse;  // whose last window would start beyond the map
  sparse.stride_y = sparse.stride_x = 4;
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.max_pool(0, 2, 2, sparse)); }), MIEN_OK);
  sparse.ceil_mode = true;
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.max_pool(0, 2, 2, sparse)); }),
            MIEN_ERROR_WEIGHTS_LAYER_SHAPE);
  for (const auto& [right, bottom] : {std::pair<std::uint16_t, std::uint16_t>{1, 0}, {0, 1}}) {
    LayerOptions narrower;  // one row or column less, which cannot be halved
    narrower.padding = {0, 0, bottom, right};
    EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.add(n.slice(0, 0, 8, narrower), 0)); }),
              MIEN_ERROR_WEIGHTS_LAYER_SHAPE);
  }
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.max_pool(0, 65537, 1)); }),
            MIEN_ERROR_WEIGHTS_LAYER_WINDOW);
}

TEST(Writer, RejectsInvalidLayersWithoutWeights) {
  LayerOptions relu;
  relu.activation = LayerActivation::kRelu;
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.add(0, 0, relu)); }),
            MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION);
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(n.softmax(1)); }),
            MIEN_ERROR_WEIGHTS_LAYER_INPUT);
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.output(0); }), MIEN_ERROR_WEIGHTS_LAYER_INPUT);
  EXPECT_EQ(status_of(kMap, [&](Net&) {}), MIEN_ERROR_WEIGHTS_NETWORK);
  EXPECT_EQ(status_of(kMap, [&](Net& n) { n.softmax(0), n.output(n.softmax(0)); }),
            MIEN_ERROR_WEIGHTS_LAYER_INPUT);
}

TEST(Writer, RejectsWeightsBeyondFp16) {
  const auto with = [](float value) {
    return status_of({1, 1, 1}, [&](NetworkWriter& n) {
      n.output(n.pointwise(0, Array{{1, 1}, {value}}, {}));
    });
  };
  EXPECT_EQ(with(65504.0f), MIEN_OK);
  EXPECT_EQ(with(65520.0f), MIEN_ERROR_WEIGHTS_TENSOR_VALUE);
  EXPECT_EQ(with(std::numeric_limits<float>::quiet_NaN()), MIEN_ERROR_WEIGHTS_TENSOR_VALUE);
}

TEST(Writer, RejectsInvalidNamesConstantsAndTexts) {
  const auto with = [](const std::function<void(MienWriter&)>& change) {
    MienWriter writer;
    NetworkWriter& net = writer.network("net", {1, 1, 1});
    net.output(net.softmax(0));
    change(writer);
    std::vector<std::byte> file;
    return writer.finish(&file).status;
  };
  EXPECT_EQ(with([](MienWriter&) {}), MIEN_OK);
  EXPECT_EQ(with([](MienWriter& w) { w.constant("Name", counting({2})); }),
            MIEN_ERROR_WEIGHTS_NAME);
  EXPECT_EQ(with([](MienWriter& w) { w.constant(std::string(64, 'a'), counting({2})); }),
            MIEN_ERROR_WEIGHTS_NAME);
  EXPECT_EQ(with([](MienWriter& w) { w.constant(std::string(63, 'a'), counting({2})); }), MIEN_OK);
  EXPECT_EQ(with([](MienWriter& w) { w.constant("", counting({2})); }),
            MIEN_ERROR_WEIGHTS_TENSOR_UNUSED);
  EXPECT_EQ(with([](MienWriter& w) {
              w.constant("a", {{3}, {1, 2}});
            }),
            MIEN_ERROR_WEIGHTS_TENSOR_DIMS);
  EXPECT_EQ(with([](MienWriter& w) {
              w.constant("a", {{1, 1, 1, 1, 1}, {1}});
            }),
            MIEN_ERROR_WEIGHTS_TENSOR_DIMS);
  EXPECT_EQ(with([](MienWriter& w) {
              w.constant("a", {{}, {1}});
            }),
            MIEN_ERROR_WEIGHTS_TENSOR_DIMS);
  EXPECT_EQ(with([](MienWriter& w) { w.metadata("key", std::string(4097, 'a')); }),
            MIEN_ERROR_WEIGHTS_METADATA);
  EXPECT_EQ(with([](MienWriter& w) { w.metadata("key", "\r"); }), MIEN_ERROR_WEIGHTS_METADATA);
  EXPECT_EQ(with([](MienWriter& w) { w.metadata("a key", ""); }), MIEN_ERROR_WEIGHTS_NAME);
}

}  // namespace
}  // namespace mien::formats
