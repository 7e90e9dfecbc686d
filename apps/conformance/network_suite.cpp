// Checks networks step by step.
#include "apps/conformance/network_suite.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <utility>

#include "apps/conformance/benchmark.h"
#include "apps/conformance/crash_guard.h"
#include "apps/mien/networks/model_files.h"
#include "apps/mien/system/failure.h"

namespace mien::conformance {
namespace {

// Tolerance relative to the largest output. Both sides use the same fp16 weights and fp32
// activations; another order of summation causes this difference at the end of a deep network.
constexpr double kTolerance = 5e-6;
// Half-precision tiers round maps between layers to 11 bits, and sums on the way: about 1e-3 of a
// layer's maximum. Over forty layers this adds up by squares to 0.7e-2; the worst of thousands of
// outputs deviates several times as much. Measured: 1.4e-2.
constexpr double kHalfTolerance = 3e-2;
// With 8 bits, the random inputs of these checks also exceed the input bounds, which are chosen for
// images, and saturate. The cases of kernels check 8 bits precisely. Measured: 0.11.
constexpr double kInt8Tolerance = 0.3;
constexpr std::size_t kSteps = 4;

class BuiltInFile : public NetworkFile {
 public:
  BuiltInFile() {
    const std::span<const std::byte> file = golden_file();
    if (weights_.create({&file, 1}) != MIEN_OK) {
      throw std::runtime_error("the built-in networks are damaged");
    }
  }
  [[nodiscard]] const Weights& weights() const override { return weights_; }

 private:
  Weights weights_;
};

class ModelFile : public NetworkFile {
 public:
  explicit ModelFile(const std::string& path) : file_({path}) {}
  [[nodiscard]] const Weights& weights() const override { return file_.weights(); }

 private:
  app::OpenedWeights file_;
};

std::size_t elements(const TensorShape& shape) {
  return static_cast<std::size_t>(shape.height) * static_cast<std::size_t>(shape.width) *
         static_cast<std::size_t>(shape.channels);
}

// Index of element i of [h][w][c] in a blocked map.
std::size_t in_blocks(const TensorShape& shape, std::size_t i) {
  const auto channels = static_cast<std::size_t>(shape.channels);
  const auto pixels =
      static_cast<std::size_t>(shape.height) * static_cast<std::size_t>(shape.width);
  return (i % channels / 8 * pixels + i / channels) * 8 + i % channels % 8;
}

void set_input(mien::Network& runner, std::span<const float> values) {
  const TensorShape shape = runner.input_shape();
  const bool interleaved = runner.input().size() == values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    runner.input()[interleaved ? i : in_blocks(shape, i)] = values[i];
  }
}

// Appends one output; returns false if an unused lane is not zero.
bool take_output(const mien::Network& runner, std::int32_t output, std::vector<float>& values) {
  const TensorShape shape = runner.output_shape(output);
  std::vector<float> blocks(runner.output(output).begin(), runner.output(output).end());
  for (std::size_t i = 0; i < elements(shape); ++i) {
    float& element = blocks[in_blocks(shape, i)];
    values.push_back(element);
    element = 0.0f;
  }
  return std::all_of(blocks.begin(), blocks.end(), [](float one) { return one == 0.0f; });
}

// Runs all steps once.
Finding run_once(mien::Network& runner, Steps& steps) {
  const std::size_t input = elements(runner.input_shape());
  steps.outputs.assign(static_cast<std::size_t>(runner.output_count()), {});
  for (std::size_t at = 0; at < steps.inputs.size(); at += input) {
    set_input(runner, std::span(steps.inputs).subspan(at, input));
    const char* crash =
        run_guarded([](void* one) { static_cast<mien::Network*>(one)->run(); }, &runner);
    if (crash != nullptr) {
      return {Fault::kCrashes, crash};
    }
    for (std::int32_t i = 0; i < runner.output_count(); ++i) {
      if (!take_output(runner, i, steps.outputs[static_cast<std::size_t>(i)])) {
        return {Fault::kWrongResult,
                "output " + std::to_string(i) + ": an unused lane is not zero"};
      }
    }
  }
  return {};
}

Finding compare(const std::vector<float>& got, const std::vector<float>& expected,
                std::size_t output, double tolerance, Fault fault) {
  if (got.size() != expected.size()) {
    return {fault, "output " + std::to_string(output) + " differs in size"};
  }
  double largest = 0.0;
  for (const float one : expected) {
    largest = std::max(largest, std::abs(static_cast<double>(one)));
  }
  Finding finding;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double error = std::abs(static_cast<double>(got[i]) - static_cast<double>(expected[i]));
    const double relative_error = got[i] == expected[i] ? 0.0 : error / (tolerance * largest);
    if (!(relative_error <= 1.0) && finding.fault == Fault::kNone) {
      char text[160];
      std::snprintf(text, sizeof text, "output %zu, element %zu: %.9g instead of %.9g +- %.2g",
                    output, i, static_cast<double>(got[i]), static_cast<double>(expected[i]),
                    tolerance * largest);
      finding = {fault, text};
    }
    finding.worst_share =
        std::max(finding.worst_share, std::isnan(relative_error) ? HUGE_VAL : relative_error);
  }
  return finding;
}

std::vector<float> random_inputs(const TensorShape& shape, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> values(-1.0f, 1.0f);
  std::vector<float> inputs(elements(shape) * kSteps);
  std::generate(inputs.begin(), inputs.end(), [&] { return values(random); });
  return inputs;
}

}  // namespace

Network::Network(std::shared_ptr<const NetworkFile> file, const std::string& file_name,
                 const NetworkInfo& info, const GoldenNetwork* golden)
    : file_(std::move(file)),
      network_(info.name),
      name_("network/" + file_name + "_" + network_),
      input_(info.input),
      macs_(info.macs),
      golden_(golden) {}

void Network::add_file(const std::shared_ptr<const NetworkFile>& file, const std::string& name,
                       std::vector<Network>& networks) {
  const WeightsContent content(file->weights());
  for (std::int32_t i = 0; i < content.network_count(); ++i) {
    const NetworkInfo info = content.network(i);
    networks.push_back(Network(file, name, info, nullptr));
    for (std::int32_t layer = 0; layer < info.layers; ++layer) {
      networks.back().has_int8_ |= content.layer(i, layer).input_bound > 0.0f;
    }
  }
}

std::vector<Network> Network::find_all(const std::string& models) {
  std::vector<Network> networks;
  add_file(std::make_shared<BuiltInFile>(), "mini", networks);
  for (Network& network : networks) {
    for (const GoldenNetwork& golden : golden_networks()) {
      network.golden_ = network.network_ == golden.name ? &golden : network.golden_;
    }
  }
  std::string folder;
  try {
    folder = app::models_directory(models);
  } catch (const app::Failure&) {
    if (!models.empty()) {
      throw;
    }
    return networks;  // a device may only have the program
  }
  if (folder.empty()) {  // MIEN_MODELS=
    return networks;
  }
  for (const auto& path : app::weight_files(folder)) {
    add_file(std::make_shared<ModelFile>(path.string()), path.stem().string(), networks);
  }
  return networks;
}

bool Network::has_cases(kernels::Tier tier) const {
  return golden_ != nullptr || tier != kernels::Tier::kRef;
}

// Other tiers supply the kernels that a tier lacks. The reference tier runs without fused blocks.
mien_status Network::create(kernels::Tier tier, const TensorShape& input, mien::Network& runner,
                            Error& error) const {
  NetworkConfig config(file_->weights(), network_.c_str());
  config.cpu_mask = kernels::up_to(tier);
  if (tier != kernels::Tier::kRef) {
    config.cpu_mask |= kernels::kFusedBlocks;
  }
  config.height = input.height;
  config.width = input.width;
  return runner.create(config, &error);
}

Finding Network::run(kernels::Tier tier, Steps& steps) const {
  mien::Network runner;
  Error error;
  if (create(tier, golden_ != nullptr ? golden_->input : input_, runner, error) != MIEN_OK) {
    return {Fault::kWrongResult, error.message()};
  }
  Finding finding = run_once(runner, steps);
  const std::vector<std::vector<float>> first = steps.outputs;
  runner.reset();
  if (finding.fault == Fault::kNone) {
    finding = run_once(runner, steps);
  }
  if (finding.fault == Fault::kNone && steps.outputs != first) {
    finding = {Fault::kWrongResult, "output differs after a reset"};
  }
  return finding;
}

Finding Network::prepare(std::uint64_t seed) {
  if (!expected_.inputs.empty() && (golden_ != nullptr || expected_seed_ == seed)) {
    return {};
  }
  expected_ = {};
  expected_seed_ = seed;
  if (golden_ == nullptr) {
    expected_.inputs = random_inputs(input_, seed);
    Finding finding = run(kernels::Tier::kRef, expected_);
    finding.text = "ref: " + finding.text;
    return finding;
  }
  expected_.inputs.assign(golden_->inputs.begin(), golden_->inputs.end());
  for (const std::span<const float> output : golden_->outputs) {
    if (!output.empty()) {
      expected_.outputs.emplace_back(output.begin(), output.end());
    }
  }
  return {};
}

Finding Network::check(kernels::Tier tier, std::uint64_t seed, int& cases) {
  ++cases;
  Finding finding = prepare(seed);
  Steps got{expected_.inputs, {}};
  if (finding.fault == Fault::kNone) {
    finding = run(tier, got);
  }
  const Fault fault = golden_ != nullptr ? Fault::kWrongResult : Fault::kDiffersFromRef;
  const double tolerance = has_int8_ && kernels::has_int8(tier) ? kInt8Tolerance
                           : kernels::is_half(tier)             ? kHalfTolerance
                                                                : kTolerance;
  double worst_share = 0.0;
  for (std::size_t i = 0; i < expected_.outputs.size() && finding.fault == Fault::kNone; ++i) {
    finding = compare(got.outputs[i], expected_.outputs[i], i, tolerance, fault);
    finding.worst_share = worst_share = std::max(worst_share, finding.worst_share);
  }
  if (finding.fault != Fault::kNone && golden_ == nullptr) {
    finding.text += "; seed " + std::to_string(seed);
  }
  return finding;
}

Timing Network::time(kernels::Tier tier, double peak) const {
  mien::Network runner;
  Error error;
  if (create(tier, input_, runner, error) != MIEN_OK) {
    throw std::runtime_error(name_ + ": " + error.message());
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<float> values(-1.0f, 1.0f);
  std::vector<float> input(elements(runner.input_shape()));
  std::generate(input.begin(), input.end(), [&] { return values(random); });
  set_input(runner, input);
  return timed([&] { runner.run(); }, macs_, peak);
}

}  // namespace mien::conformance
