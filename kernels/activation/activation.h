// Activations, fused into the previous kernel or as a layer of their own.
//
//   relu(x) = max(x, 0)          relu6(x) = min(max(x, 0), 6)
//   leaky_relu(x) = x > 0 ? x : alpha x       prelu(x) = x > 0 ? x : slope[channel] x
//   sigmoid(x) = 1 / (1 + exp(-x))            clamp01(x) = min(max(x, 0), 1)
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

enum class Activation : std::uint8_t {
  kNone = 0,
  kRelu,
  kRelu6,
  kLeakyRelu,
  kPrelu,
  kSigmoid,
  kTanh,
  kClamp01,
};

struct ActivationSpec {
  Activation kind = Activation::kNone;
  float alpha = 0.0f;                     // kLeakyRelu only
  const std::uint16_t* slopes = nullptr;  // fp16 [ceil(c/8) * 8], kPrelu only
};

// y = activation(x) on a map [ceil(c/8)][pixels][8]; y may be x. Lanes >= c become 0.
struct ActivateArgs {
  static constexpr std::string_view kFamily = "activate";
  const float* x;
  float* y;
  ActivationSpec activation;
  std::int32_t pixels;
  std::int32_t channels;
};

}  // namespace mien::kernels
