// Blocks of 8 channels for kernels/common/simd.h on tiers whose vectors have 4 lanes.
#pragma once

namespace mien::kernels::MIEN_TIER {
namespace {

using BlockVec = Pair;

struct BlockMask {
  Mask low, high;
};

inline BlockVec splat_block(float x) { return {splat(x), splat(x)}; }
inline BlockVec load_block(const float* at) { return load_pair(at); }
inline BlockVec load_block_or_zero(const float* map, std::ptrdiff_t at) {
  return map == nullptr ? splat_block(0.0f) : load_pair(map + at);
}
inline void store_block(float* at, BlockVec x) { store_pair(at, x); }

inline BlockVec add(BlockVec a, BlockVec b) { return {add(a.low, b.low), add(a.high, b.high)}; }
inline BlockVec max(BlockVec a, BlockVec b) { return {max(a.low, b.low), max(a.high, b.high)}; }
// Bitwise or: in each lane the operand that is not zero.
inline BlockVec either(BlockVec a, BlockVec b) {
  return {either(a.low, b.low), either(a.high, b.high)};
}

inline BlockMask block_mask(std::int32_t block, std::int32_t channels) {
  return {lane_mask(block * kBlock, channels), lane_mask(block * kBlock + kLanes, channels)};
}
inline BlockVec only(const BlockMask& mask, BlockVec x) {
  return {only(mask.low, x.low), only(mask.high, x.high)};
}

class BlockActivator {
 public:
  BlockActivator(const ActivationSpec& activation, std::int32_t channels)
      : activator_(activation, channels) {}

  [[nodiscard]] BlockVec begin(BlockVec x, std::int32_t /*block*/) const {
    return {activator_.clamped(x.low), activator_.clamped(x.high)};
  }
  void finish(float* y, std::int32_t pixels, std::int32_t block) const {
    if (activator_.curves()) {
      activator_.curve_block(y, pixels, block);
    }
  }

 private:
  Activator activator_;
};

}  // namespace
}  // namespace mien::kernels::MIEN_TIER
