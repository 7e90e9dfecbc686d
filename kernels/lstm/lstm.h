// One step of an LSTM cell (Hochreiter & Schmidhuber 1997, with forget gate).
//
//   i, f, o = sigmoid(W [x; h] + b), g = tanh(W [x; h] + b)
//   c <- f c + i g,   h <- o tanh(c),   y = h
//
// x: [in_elems], a multiple of 8; h, c: [hidden], hidden a multiple of 8, initially zeros; y:
// [hidden]; gates: scratch [4 hidden]. None of them may overlap. Weights: fp16 panels of 16
// outputs, [panel][in_elems + hidden][16], outputs in the order i, f, g, o. c and h below 1e-30
// become 0: otherwise silence would let them decay into denormal numbers, which are slow.
#pragma once

#include <cstdint>
#include <string_view>

namespace mien::kernels {

inline constexpr float kLstmFlush = 1e-30f;

struct LstmArgs {
  static constexpr std::string_view kFamily = "lstm";
  const float* x;
  float* h;
  float* c;
  const std::uint16_t* weights;
  const std::uint16_t* bias;  // fp16 [4 hidden]
  float* y;
  float* gates;
  std::int32_t in_elems;
  std::int32_t hidden;
};

}  // namespace mien::kernels
