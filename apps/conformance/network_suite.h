// Checks whole networks: built-in ones against PyTorch's outputs, those of weight files against the
// reference tier.
#pragma once

#include <mien/engine.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/conformance/check.h"
#include "apps/conformance/golden.h"
#include "apps/conformance/report.h"
#include "kernels/tier.h"

namespace mien::conformance {

// A weight file in memory.
class NetworkFile {
 public:
  virtual ~NetworkFile() = default;
  [[nodiscard]] virtual const Weights& weights() const = 0;
};

// Inputs and outputs of all steps, concatenated; all maps as [h][w][c].
struct Steps {
  std::vector<float> inputs;
  std::vector<std::vector<float>> outputs;
};

class Network {
 public:
  // The built-in networks and those of weight files. `models`: a folder; empty: the default of
  // `mien`, if it exists. Throws Failure if a named folder has no models.
  static std::vector<Network> find_all(const std::string& models);

  [[nodiscard]] const std::string& name() const { return name_; }  // "network/basenet_encoder"
  // False for the reference tier of a network that is compared with it.
  [[nodiscard]] bool has_cases(kernels::Tier tier) const;

  [[nodiscard]] Finding check(kernels::Tier tier, std::uint64_t seed, int& cases);
  [[nodiscard]] Timing time(kernels::Tier tier, double peak) const;

 private:
  Network(std::shared_ptr<const NetworkFile> file, const std::string& file_name,
          const NetworkInfo& info, const GoldenNetwork* golden);
  static void add_file(const std::shared_ptr<const NetworkFile>& file, const std::string& name,
                       std::vector<Network>& networks);

  [[nodiscard]] mien_status create(kernels::Tier tier, const TensorShape& input,
                                   mien::Network& runner, Error& error) const;
  // Runs all steps twice, with a reset in between, and stores the outputs.
  [[nodiscard]] Finding run(kernels::Tier tier, Steps& steps) const;
  // Computes expected_ for the seed, unless it is already.
  [[nodiscard]] Finding prepare(std::uint64_t seed);

  std::shared_ptr<const NetworkFile> file_;
  std::string network_, name_;
  TensorShape input_;  // the declared shape
  std::uint64_t macs_ = 0;
  bool has_int8_ = false;        // some layers have 8 bits
  const GoldenNetwork* golden_;  // nullptr: compare with the reference tier
  Steps expected_;               // expected outputs for expected_seed_; empty at first
  std::uint64_t expected_seed_ = 0;
};

}  // namespace mien::conformance
