// Loads eight consecutive channels that span two blocks.
#pragma once

#include "kernels/common/wasm.h"

namespace mien::kernels::wasm {
namespace {

// Copies the 8 floats of a block at `at`, or zeros if `at` is nullptr.
[[maybe_unused]] inline void copy_block(float* to, const float* at) {
  for (std::int32_t lane = 0; lane < kBlock; lane += kLanes) {
    store(to + lane, at == nullptr ? splat(0.0f) : load(at + lane));
  }
}

// Two adjacent blocks, from which any 8 consecutive lanes can be loaded.
struct TwoBlocks {
  float lanes[2 * kBlock];

  TwoBlocks(const float* low, const float* high) {
    copy_block(lanes, low);
    copy_block(lanes + kBlock, high);
  }
};

}  // namespace
}  // namespace mien::kernels::wasm
