// Channels that do not begin with a block: eight neighbours out of two blocks.
#pragma once

#include "kernels/common/wasm.h"

namespace mien::kernels::wasm {
namespace {

// The 8 floats of a block at `at`; zeros where there is none.
[[maybe_unused]] inline void copy_block(float* to, const float* at) {
  for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
    store(to + lane, at == nullptr ? splat(0.0f) : load(at + lane));
  }
}

// Two blocks side by side; any 8 lanes in a row can be loaded.
struct TwoBlocks {
  float lanes[2 * kBlock];

  TwoBlocks(const float* low, const float* high) {
    copy_block(lanes, low);
    copy_block(lanes + kBlock, high);
  }
};

}  // namespace
}  // namespace mien::kernels::wasm
