// Fused blocks of every tier against the reference, which sums in double. Every clamp passes an
// error on at most as it is, so the bound of sums of conformance_test.cpp holds for the whole
// block:
//   |got - want| <= c u S,   S = sum|w3| (sum|w2| (sum|w1 x| + |b1|) + |b2|) + |b3| + |r|
// which is the reference itself on absolute values and without activations.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/families.h"
#include "kernels/registry.h"
#include "tests/kernels/guarded.h"
#include "tests/kernels/random_values.h"

namespace mien::tests {
namespace {

using kernels::Activation;
using kernels::InvertedResidualArgs;

constexpr double kUnit = 0x1p-24;
constexpr double kSumFactor = 24.0;  // 8 for each of three sums

struct Block {
  std::vector<float> x, residual;
  std::vector<std::uint16_t> w1, b1, w2, b2, w3, b3;
  InvertedResidualArgs args{};  // sizes; pointers are set by `bound`

  explicit Block(unsigned seed) {
    RandomValues random(seed);
    InvertedResidualArgs& a = args;
    const bool expands = random.between(0, 3) > 0;
    const bool is_3x3 = random.between(0, 3) > 0;
    a.kernel_h = is_3x3 ? 3 : random.between(1, 5);
    a.kernel_w = is_3x3 ? 3 : random.between(1, 5);
    a.stride_h = random.between(1, 2);
    a.stride_w = random.between(1, 2);
    a.pad_top = random.between(0, a.kernel_h - 1);
    a.pad_left = random.between(0, a.kernel_w - 1);
    a.out_h = random.between(1, 12);
    a.out_w = random.between(1, 23);
    a.in_h = std::max(
        1, (a.out_h - 1) * a.stride_h + a.kernel_h - a.pad_top - random.between(0, a.kernel_h - 1));
    a.in_w = std::max(1, (a.out_w - 1) * a.stride_w + a.kernel_w - a.pad_left -
                             random.between(0, a.kernel_w - 1));
    a.hidden_c = random.between(1, 90);
    a.in_c = expands ? random.between(1, 40) : a.hidden_c;
    a.out_c = random.between(1, 60);
    a.residual_top = random.between(0, 2);
    a.residual_left = random.between(0, 2);
    a.residual_h = a.out_h + a.residual_top + random.between(0, 2);
    a.residual_w = a.out_w + a.residual_left + random.between(0, 2);
    tile(random);
    fill(random, expands);
  }

  [[nodiscard]] std::size_t outputs() const {
    return static_cast<std::size_t>((args.out_c + 7) / 8 * 8 * args.out_h * args.out_w);
  }

  // Everything positive, no activation: gives S.
  void make_magnitudes() {
    for (std::vector<float>* floats : {&x, &residual}) {
      for (float& one : *floats) {
        one = std::abs(one);
      }
    }
    for (std::vector<std::uint16_t>* halves : {&w1, &b1, &w2, &b2, &w3, &b3}) {
      for (std::uint16_t& one : *halves) {
        one &= 0x7FFFu;
      }
    }
    args.expand.activation = args.slide.activation = args.project.activation = {};
  }

 private:
  void tile(RandomValues& random) {
    InvertedResidualArgs& a = args;
    a.band_rows = random.between(1, a.out_h);
    a.strip_channels = 16 * random.between(1, 4);
    a.strip_rows = a.kernel_h + a.stride_h * random.between(0, 3);
    a.strip_w = std::max(a.pad_left + a.in_w, (a.out_w - 1) * a.stride_w + a.kernel_w) +
                random.between(0, 1);
  }

  void fill(RandomValues& random, bool expands) {
    const InvertedResidualArgs& a = args;
    const int hidden = (a.hidden_c + 7) / 8 * 8;
    x = random.map(a.in_h * a.in_w, a.in_c);
    if (expands) {
      w1 = random.panels(a.hidden_c, (a.in_c + 7) / 8 * 8);
      b1 = random.bias(a.hidden_c);
    }
    w2 = random.halves(hidden * a.kernel_h * a.kernel_w);
    b2 = random.bias(a.hidden_c);
    w3 = random.panels(a.out_c, hidden);
    b3 = random.bias(a.out_c);
    const bool adds = random.between(0, 1) == 1;
    residual = adds ? random.map(a.residual_h * a.residual_w, a.out_c) : std::vector<float>();
    const Activation clamps[] = {Activation::kNone, Activation::kRelu, Activation::kRelu6,
                                 Activation::kClamp01};
    args.expand.activation.kind = clamps[random.between(0, 3)];
    args.slide.activation.kind = clamps[random.between(0, 3)];
    args.project.activation.kind = clamps[random.between(0, 3)];
  }
};

// Runs a kernel with every buffer between guard pages; the scratch begins as NaNs.
std::vector<float> run(kernels::Kernel<InvertedResidualArgs> kernel, const Block& block,
                       Edge edge) {
  const Guarded<float> x(block.x, edge), residual(block.residual, edge);
  const Guarded<std::uint16_t> w1(block.w1, edge), b1(block.b1, edge), w2(block.w2, edge),
      b2(block.b2, edge), w3(block.w3, edge), b3(block.b3, edge);
  InvertedResidualArgs a = block.args;
  const auto scratch = [](std::int32_t elems) {
    return std::vector<float>(static_cast<std::size_t>(elems), std::nanf(""));
  };
  const Guarded<float> band(scratch((a.hidden_c + 7) / 8 * 8 * a.band_rows * a.out_w), edge);
  const Guarded<float> strip(scratch(a.strip_channels * a.strip_rows * a.strip_w), edge);
  const Guarded<float> wide(scratch(kernels::kInvertedResidualWideElems), edge);
  const Guarded<float> y(std::vector<float>(block.outputs(), -7.0f), edge);
  a.x = x.data();
  a.y = y.data();
  a.expand.weights = block.w1.empty() ? nullptr : w1.data();
  a.expand.bias = b1.data();
  a.slide.weights = w2.data();
  a.slide.bias = b2.data();
  a.project.weights = w3.data();
  a.project.bias = b3.data();
  a.residual = block.residual.empty() ? nullptr : residual.data();
  a.band = band.data();
  a.strip = strip.data();
  a.wide = wide.data();
  kernel(a);
  for (const Guarded<float>* one : {&x, &residual, &band, &strip, &wide, &y}) {
    EXPECT_TRUE(one->intact());
  }
  return {y.span().begin(), y.span().end()};
}

class InvertedResidualTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(InvertedResidualTest, AgreesWithTheReference) {
  const kernels::Entry* entry =
      kernels::find_entry(InvertedResidualArgs::kFamily, 1u << GetParam());
  if (entry == nullptr) {
    GTEST_SKIP() << "no such kernel here";
  }
  const auto kernel = reinterpret_cast<kernels::Kernel<InvertedResidualArgs>>(entry->function);
  for (unsigned seed = 0; seed < 120; ++seed) {
    Block block(seed);
    const std::vector<float> want = run(&kernels::ref::inverted_residual, block, Edge::kEnd);
    const std::vector<float> from_end = run(kernel, block, Edge::kEnd);
    const std::vector<float> from_start = run(kernel, block, Edge::kStart);
    block.make_magnitudes();
    const std::vector<float> sums = run(&kernels::ref::inverted_residual, block, Edge::kEnd);
    for (std::size_t i = 0; i < want.size(); ++i) {
      const double bound =
          kSumFactor * kUnit * (std::abs(static_cast<double>(sums[i])) + 0.01) + 1e-37;
      ASSERT_LE(std::abs(static_cast<double>(from_end[i]) - static_cast<double>(want[i])), bound)
          << "seed " << seed << ", element " << i;
    }
    ASSERT_EQ(from_start, from_end) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Tiers, InvertedResidualTest, testing::Range(0u, kernels::kTierCount));

}  // namespace
}  // namespace mien::tests
