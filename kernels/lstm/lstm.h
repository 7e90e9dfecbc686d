// One step of a long short-term memory cell (Hochreiter & Schmidhuber 1997, with forget gate).
//
//   i, f, o = sigmoid(W [x; h] + b), g = tanh(W [x; h] + b)
//   c <- f c + i g,   h <- o tanh(c),   y = h
//
// x: [in_elems], a multiple of 8; h, c: [hidden], hidden a multiple of 8, zeros at the beginning of
// a stream; y: [hidden]; gates: scratch [4 hidden]. No two of them overlap. Weights: fp16 panels of
// 16 outputs, [panel][in_elems + hidden][16], outputs in the order i, f, g, o. c and h are flushed
// to zero below 1e-30: in silence they would decay into denormals, which are slow.
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
