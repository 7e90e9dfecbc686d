// Small networks with random weights that use every kind of layer, and what PyTorch made of them:
// built into the program, so that a device needs no files. golden/make_golden.py made both.
#pragma once

#include <mien/engine.h>

#include <span>
#include <string_view>

namespace mien::conformance {

struct GoldenNetwork {
  std::string_view name;
  TensorShape input;                  // all zero: as declared
  std::span<const float> inputs;      // one step after another
  std::span<const float> outputs[2];  // the same; [h][w][c]
};

[[nodiscard]] std::span<const std::byte> golden_file();  // the weight file of them all
[[nodiscard]] std::span<const GoldenNetwork> golden_networks();

}  // namespace mien::conformance
