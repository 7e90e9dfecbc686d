// The vectors of kernels/common/simd.h on WebAssembly.
#pragma once

#include "kernels/common/unrolled.h"
#include "kernels/common/wasm_activation.h"

#include "kernels/common/two_vectors.h"

namespace mien::kernels::wasm {
namespace {

class LaneShift {
 public:
  // `lanes` in 0..7.
  explicit LaneShift(std::int32_t lanes)
      : by_vector_(lanes >= kLanes),
        from_first_(
            wasm_i8x16_add(wasm_i8x16_const(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15),
                           wasm_i8x16_splat(static_cast<std::int8_t>(lanes % kLanes * 4)))),
        from_second_(wasm_i8x16_sub(from_first_, wasm_i8x16_splat(16))) {}

  // Lanes `lanes` .. `lanes` + 7 of the concatenation of `low` and `high`.
  [[nodiscard]] BlockVec apply(BlockVec low, BlockVec high) const {
    return by_vector_ ? BlockVec{joined(low.high, high.low), joined(high.low, high.high)}
                      : BlockVec{joined(low.low, low.high), joined(low.high, high.low)};
  }

 private:
  // A swizzle gives 0 for the bytes of the other vector.
  [[nodiscard]] Vec joined(Vec first, Vec second) const {
    return wasm_v128_or(wasm_i8x16_swizzle(first, from_first_),
                        wasm_i8x16_swizzle(second, from_second_));
  }

  bool by_vector_;
  Vec from_first_, from_second_;  // indices of bytes
};

}  // namespace
}  // namespace mien::kernels::wasm
