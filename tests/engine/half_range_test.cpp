// Proves that no value in the published encoders can exceed half precision, for any input: bounds
// from the weights alone, including the rounding of each product and sum. Therefore the tracker may
// run them on tiers that compute in fp16.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "formats/fp16.h"
#include "tests/engine/owned_session.h"

namespace mien::tests {
namespace {

using formats::LayerActivation;
using formats::LayerOp;
using formats::LayerRecord;

constexpr double kMaxHalf = 65504.0;
constexpr double kRounding = 0x1p-11;  // relative, of one fp16 addition or multiplication
constexpr double kInput = 1.0;         // crops are pixels from -1 to 1

// The largest possible magnitude of each channel of a value.
using Bounds = std::vector<double>;

class NetworkBounds {
 public:
  NetworkBounds(const formats::FileView& file, const formats::NetworkRecord& network)
      : file_(file),
        layers_(file.layers(network)),
        values_{Bounds(network.input_channels, kInput)} {
    for (const LayerRecord& layer : layers_) {
      values_.push_back(out_of(layer));
    }
  }
  // The maximum over all values and all partial sums, for any order of summation.
  [[nodiscard]] double largest() const { return largest_; }

 private:
  [[nodiscard]] double half(std::uint32_t tensor, std::size_t i) const {
    const auto data = file_.data(file_.tensors()[tensor]);
    std::uint16_t bits;
    std::memcpy(&bits, data.data() + 2 * i, sizeof bits);
    return static_cast<double>(formats::float_from_fp16(bits));
  }

  Bounds out_of(const LayerRecord& layer) {
    const Bounds& x = values_[layer.input];
    Bounds y(layer.channels);
    for (std::size_t o = 0; o < y.size(); ++o) {
      y[o] = layer.op == static_cast<std::uint16_t>(LayerOp::kAdd)
                 ? (x[o] + values_[layer.second_input][o]) * (1.0 + kRounding)
                 : sum_bound(layer, x, o);
      largest_ = std::max(largest_, y[o]);
      y[o] = activated(layer, y[o]);
    }
    return y;
  }

  [[nodiscard]] double sum_bound(const LayerRecord& layer, const Bounds& x, std::size_t o) const {
    const std::size_t taps = std::size_t{layer.kernel_height} * layer.kernel_width;
    double sum = std::abs(half(layer.bias, o));
    switch (static_cast<LayerOp>(layer.op)) {
      case LayerOp::kDepthwise:  // [block][tap][8]
        for (std::size_t tap = 0; tap < taps; ++tap) {
          sum += x[o] * std::abs(half(layer.weights, (o / 8 * taps + tap) * 8 + o % 8));
        }
        return rounded(sum, taps);
      case LayerOp::kConv2d:
        return rounded(sum + panel_bound(layer, o, taps * x.size(),
                                         [&](std::size_t k) { return x[k % x.size()]; }),
                       taps * x.size());
      case LayerOp::kPointwise:
        return rounded(sum + panel_bound(layer, o, (x.size() + 7) / 8 * 8,
                                         [&](std::size_t k) { return k < x.size() ? x[k] : 0.0; }),
                       x.size());
      default:
        ADD_FAILURE() << "unknown layer";
        return HUGE_VAL;
    }
  }

  // Panels [panel][reduction][16], the last 8 wide if the blocks of outputs are odd.
  template <class X>
  [[nodiscard]] double panel_bound(const LayerRecord& layer, std::size_t o, std::size_t reduction,
                                   X x) const {
    const std::size_t padded = (std::size_t{layer.channels} + 7) / 8 * 8, first = o / 16 * 16;
    const std::size_t width = std::min<std::size_t>(16, padded - first);
    double sum = 0.0;
    for (std::size_t k = 0; k < reduction; ++k) {
      sum += x(k) * std::abs(half(layer.weights, first * reduction + k * width + o - first));
    }
    return sum;
  }

  // A bias plus this number of rounded products, added in any order, with every addition rounded.
  static double rounded(double sum, std::size_t products) {
    return sum * std::pow(1.0 + kRounding, static_cast<double>(products + 1));
  }

  static double activated(const LayerRecord& layer, double bound) {
    switch (static_cast<LayerActivation>(layer.activation)) {
      case LayerActivation::kRelu6:
        return std::min(bound, 6.0);
      case LayerActivation::kClamp01:
        return std::min(bound, 1.0);
      case LayerActivation::kNone:
      case LayerActivation::kRelu:
        return bound;
      default:
        ADD_FAILURE() << "unknown activation";
        return HUGE_VAL;
    }
  }

  const formats::FileView& file_;
  std::span<const LayerRecord> layers_;
  std::vector<Bounds> values_;
  double largest_ = 0.0;
};

bool has_blocks(std::span<const LayerRecord> layers) {
  return std::any_of(layers.begin(), layers.end(), [](const LayerRecord& layer) {
    return layer.op == static_cast<std::uint16_t>(LayerOp::kDepthwise);
  });
}

TEST(HalfRange, PublishedEncodersStayWithinIt) {
  int encoders = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MIEN_SOURCE_DIR "/models")) {
    if (entry.path().extension() != ".mien") {
      continue;
    }
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::vector<char> content((std::istreambuf_iterator<char>(stream)), {});
    AlignedBuffer bytes(std::as_bytes(std::span(content)));
    formats::FileView file;
    ASSERT_EQ(formats::open(bytes.span(), file).status, MIEN_OK);
    for (const formats::NetworkRecord& network : file.networks()) {
      if (!has_blocks(file.layers(network))) {
        continue;
      }
      const double largest = NetworkBounds(file, network).largest();
      RecordProperty(entry.path().stem().string(), std::to_string(largest));
      EXPECT_LT(largest, kMaxHalf) << entry.path();
      ++encoders;
    }
  }
  EXPECT_GE(encoders, 2);
}

}  // namespace
}  // namespace mien::tests
