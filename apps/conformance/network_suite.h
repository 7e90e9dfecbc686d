// Whole networks: those built in against what PyTorch made of them, those in weight files against
// the reference tier.
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
  [[nodiscard]] virtual const WeightFile& view() const = 0;
};

// What goes in and what comes out, one step after another, all maps as [h][w][c].
struct Steps {
  std::vector<float> inputs;
  std::vector<std::vector<float>> outputs;
};

class Network {
 public:
  // The built-in networks and, where weight files are found, all of theirs. `models`: a folder;
  // empty: where `mien` looks for it. Throws Failure if the folder was named and has no models.
  static std::vector<Network> find_all(const std::string& models);

  [[nodiscard]] const std::string& name() const { return name_; }  // "network/basenet_encoder"
  // The reference tier is not held against itself.
  [[nodiscard]] bool has_cases(kernels::Tier tier) const;

  [[nodiscard]] Finding check(kernels::Tier tier, std::uint64_t seed, int& cases);
  [[nodiscard]] Timing time(kernels::Tier tier, double peak) const;

 private:
  Network(std::shared_ptr<const NetworkFile> file, const std::string& file_name,
          const NetworkInfo& info, const GoldenNetwork* golden);
  static void add_file(const std::shared_ptr<const NetworkFile>& file, const std::string& name,
                       std::vector<Network>& networks);

  [[nodiscard]] EngineStatus create(kernels::Tier tier, const TensorShape& input,
                                    NetworkRunner& runner) const;
  // Runs all steps twice, with a reset between, and fills in the outputs.
  [[nodiscard]] Finding run(kernels::Tier tier, Steps& steps) const;
  // Sees to it that wanted_ is that of the seed.
  [[nodiscard]] Finding prepare(std::uint64_t seed);

  std::shared_ptr<const NetworkFile> file_;
  std::string network_, name_;
  TensorShape input_;  // as declared
  std::uint64_t macs_ = 0;
  const GoldenNetwork* golden_;  // nullptr: none
  Steps wanted_;                 // of wanted_seed_, once there are any
  std::uint64_t wanted_seed_ = 0;
};

}  // namespace mien::conformance
