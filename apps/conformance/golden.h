// Small networks with random weights that use every kind of layer, and PyTorch's outputs, embedded
// in the program so that a device needs no files. golden/make_golden.py creates both.
#pragma once

#include <mien/engine.h>

#include <span>
#include <string_view>

namespace mien::conformance {

struct GoldenNetwork {
  std::string_view name;
  TensorShape input;                  // all zero: the declared shape
  std::span<const float> inputs;      // all steps, concatenated
  std::span<const float> outputs[2];  // likewise; [h][w][c]
};

[[nodiscard]] std::span<const std::byte> golden_file();  // the weight file of all networks
[[nodiscard]] std::span<const GoldenNetwork> golden_networks();

}  // namespace mien::conformance
