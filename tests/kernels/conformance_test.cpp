// Every kernel of every tier this CPU has, against the reference tier, which sums in double:
//   |got - want| <= c u sum|x w| + rounding of the output
// where sum|x w| comes from the reference itself, run on absolute values. Buffers lie between guard
// pages, first at one, then at the other; canaries fill the rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "kernels/families.h"
#include "kernels/registry.h"
#include "tests/kernels/guarded.h"
#include "tests/kernels/random_values.h"

namespace mien::tests {
namespace {

using namespace kernels;  // NOLINT: the test is about nothing else

constexpr double kUnit = 0x1p-24;  // rounding unit of fp32
constexpr double kSumFactor =
    8.0;  // c: room for the order of the sum and the activation's own error
constexpr int kCasesPerKernel = 60;

std::vector<float> absolute(std::vector<float> values) {
  for (float& one : values) {
    one = std::abs(one);
  }
  return values;
}

std::vector<std::uint16_t> absolute(std::vector<std::uint16_t> halves) {
  for (std::uint16_t& one : halves) {
    one &= 0x7FFFu;
  }
  return halves;
}

// One case of a kernel: inputs by role, and a way to run some kernel of the family on buffers.
struct Buffers {
  std::vector<std::vector<float>> floats;          // read, or read and written
  std::vector<std::vector<std::uint16_t>> halves;  // read
  std::size_t outputs = 0;                         // floats of y
};

template <class Args>
struct Case {
  Buffers buffers;
  std::function<void(Args&, float* const* floats, const std::uint16_t* const* halves, float* y)>
      bind;
  std::function<void(Args&)> without_activation = [](Args&) {};
  double gain = 1.0;  // the activation's steepest slope
};

template <class Args>
std::vector<float> run_plain(Kernel<Args> kernel, const Case<Args>& test, const Buffers& buffers,
                             bool plain_sum) {
  Buffers copy = buffers;
  std::vector<float*> floats;
  std::vector<const std::uint16_t*> halves;
  for (auto& one : copy.floats) {
    floats.push_back(one.data());
  }
  for (auto& one : copy.halves) {
    halves.push_back(one.data());
  }
  std::vector<float> y(copy.outputs, -7.0f);
  Args args{};
  test.bind(args, floats.data(), halves.data(), y.data());
  if (plain_sum) {
    test.without_activation(args);
  }
  kernel(args);
  return y;
}

template <class Args>
std::vector<float> run_guarded(Kernel<Args> kernel, const Case<Args>& test, Edge edge) {
  std::vector<std::unique_ptr<Guarded<float>>> floats;
  std::vector<std::unique_ptr<Guarded<std::uint16_t>>> halves;
  std::vector<float*> float_pointers;
  std::vector<const std::uint16_t*> half_pointers;
  for (const auto& one : test.buffers.floats) {
    floats.push_back(std::make_unique<Guarded<float>>(one, edge));
    float_pointers.push_back(floats.back()->data());
  }
  for (const auto& one : test.buffers.halves) {
    halves.push_back(std::make_unique<Guarded<std::uint16_t>>(one, edge));
    half_pointers.push_back(halves.back()->data());
  }
  Guarded<float> y(std::vector<float>(test.buffers.outputs, -7.0f), edge);
  Args args{};
  test.bind(args, float_pointers.data(), half_pointers.data(), y.data());
  kernel(args);
  EXPECT_TRUE(y.intact());
  for (const auto& one : floats) {
    EXPECT_TRUE(one->intact());
  }
  return {y.span().begin(), y.span().end()};
}

// Empty if all is well, else what is wrong first.
template <class Args>
std::string difference(const Case<Args>& test, const std::vector<float>& got) {
  const std::vector<float> want = run_plain(find<Args>(bit(Tier::kRef)), test, test.buffers, false);
  Buffers magnitudes = test.buffers;
  for (auto& one : magnitudes.floats) {
    one = absolute(one);
  }
  for (auto& one : magnitudes.halves) {
    one = absolute(one);
  }
  const std::vector<float> sums = run_plain(find<Args>(bit(Tier::kRef)), test, magnitudes, true);
  for (std::size_t i = 0; i < want.size(); ++i) {
    const double bound = kSumFactor * kUnit *
                             (test.gain * std::abs(static_cast<double>(sums[i])) +
                              std::abs(static_cast<double>(want[i])) + 0.01) +
                         1e-37;
    const double error = std::abs(static_cast<double>(got[i]) - static_cast<double>(want[i]));
    if (!(error <= bound)) {
      return "element " + std::to_string(i) + ": got " + std::to_string(got[i]) + ", want " +
             std::to_string(want[i]) + ", bound " + std::to_string(bound);
    }
  }
  return "";
}

template <class Args>
void check_all_tiers(const std::function<Case<Args>(RandomValues&)>& make) {
  for (std::uint32_t tier = 0; tier < kTierCount; ++tier) {
    const std::uint32_t mask = 1u << tier;
    if ((detect_cpu() & mask) == 0) {
      continue;
    }
    const Kernel<Args> kernel = find<Args>(mask);
    ASSERT_NE(kernel, nullptr) << name(static_cast<Tier>(tier));
    for (unsigned seed = 0; seed < kCasesPerKernel; ++seed) {
      RandomValues random(seed);
      const Case<Args> test = make(random);
      for (const Edge edge : {Edge::kEnd, Edge::kStart}) {
        const std::string wrong = difference(test, run_guarded(kernel, test, edge));
        ASSERT_EQ(wrong, "") << name(static_cast<Tier>(tier)) << ", seed " << seed;
      }
    }
  }
}

struct RandomActivation {
  ActivationSpec spec;
  std::vector<std::uint16_t> slopes;
  double gain = 1.0;

  RandomActivation(RandomValues& random, int channels) : slopes(random.bias(channels)) {
    spec.kind = static_cast<Activation>(random.between(0, 7));
    spec.alpha = 0.1f;
    gain = spec.kind == Activation::kPrelu ? 2.0 : 1.0;
  }
};

template <class Args>
void no_activation(Args& args) {
  args.activation = {};
}

std::size_t padded(int n) { return static_cast<std::size_t>((n + 7) / 8 * 8); }

TEST(Conformance, Pointwise) {
  check_all_tiers<PointwiseArgs>([](RandomValues& random) {
    const int h = random.between(1, 9), w = random.between(1, 9);
    const int in = random.between(1, 40), out = random.between(1, 56);
    const int top = random.between(0, 2), left = random.between(0, 2);
    const int rh = h + top + random.between(0, 2), rw = w + left + random.between(0, 2);
    const bool residual = random.between(0, 1) == 1;
    const RandomActivation activation(random, out);
    Case<PointwiseArgs> test;
    test.buffers = {
        {random.map(h * w, in), random.map(rh * rw, out)},
        {random.panels(out, static_cast<int>(padded(in))), random.bias(out), activation.slopes},
        padded(out) * static_cast<std::size_t>(h * w)};
    test.gain = activation.gain;
    test.without_activation = no_activation<PointwiseArgs>;
    test.bind = [=](PointwiseArgs& a, float* const* f, const std::uint16_t* const* halves,
                    float* y) {
      a = {f[0], halves[0], halves[1], y,   activation.spec,
           h,    w,         in,        out, residual ? f[1] : nullptr,
           rh,   rw,        top,       left};
      a.activation.slopes = halves[2];
    };
    return test;
  });
}

TEST(Conformance, Conv2d) {
  check_all_tiers<Conv2dArgs>([](RandomValues& random) {
    const int kh = random.between(1, 5), kw = random.between(1, 5);
    const int sh = random.between(1, 3), sw = random.between(1, 3);
    const int top = random.between(0, kh - 1), left = random.between(0, kw - 1);
    const int oh = random.between(1, 7), ow = random.between(1, 15);
    // The map may end before the last window does: that is padding at the bottom and right.
    const int ih = std::max(1, (oh - 1) * sh + kh - top - random.between(0, kh - 1));
    const int iw = std::max(1, (ow - 1) * sw + kw - left - random.between(0, kw - 1));
    const bool interleaved = random.between(0, 1) == 1;
    const int in = interleaved ? random.between(1, 4) : random.between(1, 21);
    const int out = random.between(1, 40);
    const RandomActivation activation(random, out);
    Case<Conv2dArgs> test;
    test.buffers = {{interleaved ? random.plain(ih * iw * in) : random.map(ih * iw, in)},
                    {random.panels(out, kh * kw * in), random.bias(out), activation.slopes},
                    padded(out) * static_cast<std::size_t>(oh * ow)};
    test.gain = activation.gain;
    test.without_activation = no_activation<Conv2dArgs>;
    test.bind = [=](Conv2dArgs& a, float* const* f, const std::uint16_t* const* halves, float* y) {
      a = {f[0],
           halves[0],
           halves[1],
           y,
           activation.spec,
           ih,
           iw,
           in,
           interleaved ? in : 8,
           oh,
           ow,
           out,
           kh,
           kw,
           sh,
           sw,
           top,
           left};
      a.activation.slopes = halves[2];
    };
    return test;
  });
}

TEST(Conformance, Depthwise) {
  check_all_tiers<DepthwiseArgs>([](RandomValues& random) {
    const bool three = random.between(0, 2) > 0;
    const int kh = three ? 3 : random.between(1, 5), kw = three ? 3 : random.between(1, 5);
    const int sh = random.between(1, 2), sw = random.between(1, 2);
    const int top = random.between(0, kh - 1), left = random.between(0, kw - 1);
    const int oh = random.between(1, 7), ow = random.between(1, 15);
    const int ih = std::max(1, (oh - 1) * sh + kh - top - random.between(0, kh - 1));
    const int iw = std::max(1, (ow - 1) * sw + kw - left - random.between(0, kw - 1));
    const int channels = random.between(1, 33);
    const RandomActivation activation(random, channels);
    Case<DepthwiseArgs> test;
    std::vector<std::uint16_t> weights =
        random.halves(static_cast<int>(padded(channels)) * kh * kw);
    test.buffers = {{random.map(ih * iw, channels)},
                    {weights, random.bias(channels), activation.slopes},
                    padded(channels) * static_cast<std::size_t>(oh * ow)};
    test.gain = activation.gain;
    test.without_activation = no_activation<DepthwiseArgs>;
    test.bind = [=](DepthwiseArgs& a, float* const* f, const std::uint16_t* const* halves,
                    float* y) {
      a = {f[0], halves[0], halves[1], y,   activation.spec, channels, ih, iw, oh, ow, kh, kw,
           sh,   sw,        top,       left};
      a.activation.slopes = halves[2];
    };
    return test;
  });
}

TEST(Conformance, FullyConnected) {
  check_all_tiers<FullyConnectedArgs>([](RandomValues& random) {
    const int in = 8 * random.between(1, 40), out = random.between(1, 70);
    const RandomActivation activation(random, out);
    Case<FullyConnectedArgs> test;
    test.buffers = {{random.plain(in)},
                    {random.panels(out, in), random.bias(out), activation.slopes},
                    padded(out)};
    test.gain = activation.gain;
    test.without_activation = no_activation<FullyConnectedArgs>;
    test.bind = [=](FullyConnectedArgs& a, float* const* f, const std::uint16_t* const* halves,
                    float* y) {
      a = {f[0], halves[0], halves[1], y, activation.spec, in, out};
      a.activation.slopes = halves[2];
    };
    return test;
  });
}

TEST(Conformance, CausalConvKeepsItsInput) {
  check_all_tiers<CausalConvArgs>([](RandomValues& random) {
    const int in = 8 * random.between(1, 20), out = random.between(1, 50);
    const RandomActivation activation(random, out);
    Case<CausalConvArgs> test;
    test.buffers = {{random.plain(in), random.plain(in)},
                    {random.panels(out, 2 * in), random.bias(out), activation.slopes},
                    padded(out)};
    test.gain = activation.gain;
    test.without_activation = no_activation<CausalConvArgs>;
    test.bind = [=](CausalConvArgs& a, float* const* f, const std::uint16_t* const* halves,
                    float* y) {
      a = {f[0], f[1], halves[0], halves[1], y, activation.spec, in, out};
      a.activation.slopes = halves[2];
    };
    return test;
  });
  for (const Entry& entry : all_kernels()) {
    if (entry.family != CausalConvArgs::kFamily || (detect_cpu() & bit(entry.tier)) == 0) {
      continue;
    }
    RandomValues random(1);
    const std::vector<float> x = random.plain(16);
    std::vector<float> previous(16), y(8);
    const auto weights = random.panels(8, 32);
    const auto bias = random.bias(8);
    find<CausalConvArgs>(bit(entry.tier))(
        {x.data(), previous.data(), weights.data(), bias.data(), y.data(), {}, 16, 8});
    EXPECT_EQ(previous, x) << name(entry.tier);
  }
}

// Gates saturate, so the bound of sums does not fit: states are compared over many steps instead.
TEST(Conformance, LstmOverManySteps) {
  constexpr int kIn = 16, kHidden = 24, kSteps = 200;
  for (std::uint32_t tier = 1; tier < kTierCount; ++tier) {
    const std::uint32_t mask = 1u << tier;
    if ((detect_cpu() & mask) == 0) {
      continue;
    }
    RandomValues random(5);
    const auto weights = random.panels(4 * kHidden, kIn + kHidden);
    const auto bias = random.bias(4 * kHidden);
    std::vector<float> state[2][2], y[2], gates(4 * kHidden);
    for (auto& cell : state) {
      cell[0].assign(kHidden, 0.0f);
      cell[1].assign(kHidden, 0.0f);
    }
    for (auto& one : y) {
      one.resize(kHidden);
    }
    for (int step = 0; step < kSteps; ++step) {
      const std::vector<float> x = random.plain(kIn);
      for (int i = 0; i < 2; ++i) {
        find<LstmArgs>(i == 0 ? bit(Tier::kRef) : mask)(
            {x.data(), state[i][0].data(), state[i][1].data(), weights.data(), bias.data(),
             y[i].data(), gates.data(), kIn, kHidden});
      }
      for (int j = 0; j < kHidden; ++j) {
        ASSERT_NEAR(y[0][static_cast<std::size_t>(j)], y[1][static_cast<std::size_t>(j)], 2e-5)
            << name(static_cast<Tier>(tier)) << ", step " << step;
      }
    }
  }
}

TEST(Conformance, MaxPool) {
  check_all_tiers<MaxPoolArgs>([](RandomValues& random) {
    const int k = random.between(1, 3), s = random.between(1, 3), channels = random.between(1, 20);
    const int ih = random.between(k, 12), iw = random.between(k, 12);
    const auto outputs = [&](int size) { return (size - k + s - 1) / s + 1; };
    const int oh = std::min(outputs(ih), (ih + s - 1) / s),
              ow = std::min(outputs(iw), (iw + s - 1) / s);
    Case<MaxPoolArgs> test;
    test.buffers = {
        {random.map(ih * iw, channels)}, {}, padded(channels) * static_cast<std::size_t>(oh * ow)};
    test.bind = [=](MaxPoolArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], y, channels, ih, iw, oh, ow, k, k, s, s, 0, 0};
    };
    return test;
  });
}

TEST(Conformance, GlobalAveragePool) {
  check_all_tiers<GlobalAveragePoolArgs>([](RandomValues& random) {
    const int pixels = random.between(1, 90), channels = random.between(1, 20);
    Case<GlobalAveragePoolArgs> test;
    test.buffers = {{random.map(pixels, channels)}, {}, padded(channels)};
    test.bind = [=](GlobalAveragePoolArgs& a, float* const* f, const std::uint16_t* const*,
                    float* y) {
      a = {f[0], y, pixels, channels};
    };
    return test;
  });
}

TEST(Conformance, Concat) {
  check_all_tiers<ConcatArgs>([](RandomValues& random) {
    const int pixels = random.between(1, 9), a_channels = random.between(1, 34),
              b_channels = random.between(1, 34);
    Case<ConcatArgs> test;
    test.buffers = {{random.map(pixels, a_channels), random.map(pixels, b_channels)},
                    {},
                    padded(a_channels + b_channels) * static_cast<std::size_t>(pixels)};
    test.bind = [=](ConcatArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], f[1], y, pixels, a_channels, b_channels};
    };
    return test;
  });
}

TEST(Conformance, Slice) {
  check_all_tiers<SliceArgs>([](RandomValues& random) {
    const int h = random.between(1, 6), w = random.between(1, 6), channels = random.between(1, 24);
    const int top = random.between(0, 2), left = random.between(0, 2);
    const int ih = h + top + random.between(0, 2), iw = w + left + random.between(0, 2);
    const int first = random.between(0, 20), in = first + channels + random.between(0, 9);
    Case<SliceArgs> test;
    test.buffers = {
        {random.map(ih * iw, in)}, {}, padded(channels) * static_cast<std::size_t>(h * w)};
    test.bind = [=](SliceArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], y, ih, iw, top, left, first, h, w, channels};
    };
    return test;
  });
}

TEST(Conformance, Activate) {
  check_all_tiers<ActivateArgs>([](RandomValues& random) {
    const int pixels = random.between(1, 30), channels = random.between(1, 20);
    const RandomActivation activation(random, channels);
    Case<ActivateArgs> test;
    test.buffers = {{random.map(pixels, channels)},
                    {activation.slopes},
                    padded(channels) * static_cast<std::size_t>(pixels)};
    test.gain = activation.gain;
    test.without_activation = no_activation<ActivateArgs>;
    test.bind = [=](ActivateArgs& a, float* const* f, const std::uint16_t* const* halves,
                    float* y) {
      a = {f[0], y, activation.spec, pixels, channels};
      a.activation.slopes = halves[0];
    };
    return test;
  });
}

TEST(Conformance, Softmax) {
  check_all_tiers<SoftmaxArgs>([](RandomValues& random) {
    const int pixels = random.between(1, 9), channels = random.between(1, 20);
    Case<SoftmaxArgs> test;
    test.buffers = {
        {random.map(pixels, channels)}, {}, padded(channels) * static_cast<std::size_t>(pixels)};
    test.bind = [=](SoftmaxArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], y, pixels, channels};
    };
    test.gain = 4.0;  // shares are 1 in sum; their errors are those of the exponential
    return test;
  });
}

TEST(Conformance, MatrixVector) {
  check_all_tiers<MatrixVectorArgs>([](RandomValues& random) {
    const int rows = random.between(1, 30), columns = random.between(1, 140);
    Case<MatrixVectorArgs> test;
    test.buffers = {
        {random.plain(rows * columns), random.plain(columns)}, {}, static_cast<std::size_t>(rows)};
    test.bind = [=](MatrixVectorArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], f[1], y, rows, columns};
    };
    return test;
  });
}

TEST(Conformance, PowerSpectrum) {
  check_all_tiers<PowerSpectrumArgs>([](RandomValues& random) {
    const int n = PowerSpectrumArgs::kSmallest << random.between(0, 3);
    std::vector<float> twiddles;
    for (int j = 0; j < n; ++j) {
      const double turn = 2.0 * std::numbers::pi * j / n;
      twiddles.push_back(static_cast<float>(std::cos(turn)));
      twiddles.push_back(static_cast<float>(-std::sin(turn)));
    }
    Case<PowerSpectrumArgs> test;
    test.buffers = {{random.plain(n), twiddles}, {}, static_cast<std::size_t>(n / 2 + 1)};
    test.bind = [=](PowerSpectrumArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], f[1], y, n};
    };
    return test;
  });
}

TEST(Conformance, ResidualAdd) {
  check_all_tiers<ResidualAddArgs>([](RandomValues& random) {
    const int h = random.between(1, 9), w = random.between(1, 9), channels = random.between(1, 20);
    const int top = random.between(0, 2), left = random.between(0, 2);
    const int rh = h + top + random.between(0, 2), rw = w + left + random.between(0, 2);
    Case<ResidualAddArgs> test;
    test.buffers = {{random.map(h * w, channels), random.map(rh * rw, channels)},
                    {},
                    padded(channels) * static_cast<std::size_t>(h * w)};
    test.bind = [=](ResidualAddArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], f[1], y, channels, h, w, rh, rw, top, left};
    };
    return test;
  });
}

TEST(Conformance, BatchNorm) {
  check_all_tiers<BatchNormArgs>([](RandomValues& random) {
    const int pixels = random.between(1, 9), channels = random.between(1, 20);
    std::vector<float> variance = random.plain(channels);
    for (float& one : variance) {
      one = one * one + 0.1f;
    }
    Case<BatchNormArgs> test;
    test.buffers = {{random.map(pixels, channels), random.plain(channels), variance,
                     random.plain(channels), random.plain(channels)},
                    {},
                    padded(channels) * static_cast<std::size_t>(pixels)};
    // |x| - |m| is no bound of |x - m|: negate the mean where magnitudes are summed.
    test.without_activation = [](BatchNormArgs& a) {
      for (int c = 0; c < a.channels; ++c) {
        const_cast<float*>(a.mean)[c] = -std::abs(a.mean[c]);
      }
    };
    test.bind = [=](BatchNormArgs& a, float* const* f, const std::uint16_t* const*, float* y) {
      a = {f[0], y, f[1], f[2], f[3], f[4], 1e-5f, pixels, channels};
    };
    return test;
  });
}

// The harness must notice a kernel that is wrong.
void half_of_the_sum(const FullyConnectedArgs& a) {
  ref::fully_connected(a);
  a.y[a.out_c - 1] *= 1.001f;
}
void writes_past_the_end(const FullyConnectedArgs& a) {
  ref::fully_connected(a);
  a.y[(a.out_c + 7) / 8 * 8] = 1.0f;
}
void reads_past_the_end(const FullyConnectedArgs& a) {
  ref::fully_connected(a);
  a.y[0] += 0.0f * a.x[a.in_elems];
}

Case<FullyConnectedArgs> simple_case() {
  RandomValues random(3);
  Case<FullyConnectedArgs> test;
  test.buffers = {{random.plain(16)}, {random.panels(10, 16), random.bias(10)}, 16};
  test.without_activation = no_activation<FullyConnectedArgs>;
  test.bind = [](FullyConnectedArgs& a, float* const* f, const std::uint16_t* const* halves,
                 float* y) { a = {f[0], halves[0], halves[1], y, {}, 16, 10}; };
  return test;
}

TEST(Harness, NoticesAWrongTail) {
  const Case<FullyConnectedArgs> test = simple_case();
  EXPECT_NE(difference(test, run_guarded<FullyConnectedArgs>(half_of_the_sum, test, Edge::kEnd)),
            "");
}

TEST(HarnessDeathTest, NoticesAWritePastTheEnd) {
  const Case<FullyConnectedArgs> test = simple_case();
  EXPECT_DEATH(run_guarded<FullyConnectedArgs>(writes_past_the_end, test, Edge::kEnd), "");
}

TEST(HarnessDeathTest, NoticesAReadPastTheEnd) {
  const Case<FullyConnectedArgs> test = simple_case();
  EXPECT_DEATH(run_guarded<FullyConnectedArgs>(reads_past_the_end, test, Edge::kEnd), "");
}

}  // namespace
}  // namespace mien::tests
