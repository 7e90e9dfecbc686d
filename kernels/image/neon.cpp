// The neon and neon32 tiers of warp.
#include "kernels/common/neon.h"
#include "kernels/families.h"
#include "kernels/image/tiles.h"

namespace mien::kernels::MIEN_TIER {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = MIEN_TIER::kLanes;
  using Vec = float32x4_t;
  using Ints = int32x4_t;
  using Neighbours = tiles::Gathered<Simd>;

  static Vec splat(float x) { return vdupq_n_f32(x); }
  static Vec load(const float* at) { return vld1q_f32(at); }
  static Vec count_from(float first) {
    static constexpr float kOrder[kLanes] = {0.0f, 1.0f, 2.0f, 3.0f};
    return vaddq_f32(splat(first), vld1q_f32(kOrder));
  }
  static Vec fma(Vec sum, Vec a, Vec b) { return vfmaq_f32(sum, a, b); }
  static Vec sub(Vec a, Vec b) { return vsubq_f32(a, b); }
  static Vec min(Vec a, Vec b) { return vminq_f32(a, b); }
  static Vec max(Vec a, Vec b) { return vmaxq_f32(a, b); }
  static Vec floor(Vec x) { return MIEN_TIER::floor(x); }
  static Ints equal(Vec a, Vec b) { return vreinterpretq_s32_u32(vceqq_f32(a, b)); }
  // Comparisons with NaN are false.
  static Vec finite_or_0(Vec x) { return only(vcleq_f32(vabsq_f32(x), splat(3.0e38f)), x); }
  static Ints to_ints(Vec x) { return vcvtq_s32_f32(x); }
  static void store(std::int32_t* at, Ints x) { vst1q_s32(at, x); }

  struct Weights {
    uint16x4_t here, next;
  };
  static Weights weights_of(Vec across) {
    const Vec rounded = fma(splat(0.5f), across, splat(tiles::kOne));
    const uint16x4_t next = vmovn_u32(vcvtq_u32_f32(rounded));
    return {vsub_u16(vdup_n_u16(tiles::kOne), next), next};
  }
  static Vec gather(const std::uint16_t* base, Ints index, Weights weights) {
    const auto pair = [&](std::int32_t i) {
      std::uint32_t both;
      __builtin_memcpy(&both, base + i, sizeof both);
      return both;
    };
    uint32x4_t pairs = vdupq_n_u32(pair(vgetq_lane_s32(index, 0)));
    pairs = vsetq_lane_u32(pair(vgetq_lane_s32(index, 1)), pairs, 1);
    pairs = vsetq_lane_u32(pair(vgetq_lane_s32(index, 2)), pairs, 2);
    pairs = vsetq_lane_u32(pair(vgetq_lane_s32(index, 3)), pairs, 3);
    const uint32x4_t here = vmull_u16(vmovn_u32(pairs), weights.here);
    return vcvtq_f32_u32(vmlal_u16(here, vshrn_n_u32(pairs, 16), weights.next));
  }

  static void store_rgb(float* at, Vec r, Vec g, Vec b) {
    const float32x4x3_t pixels = {{r, g, b}};
    vst3q_f32(at, pixels);
  }

  static constexpr std::int32_t kSums = 8;
  using Sums = uint16x8_t;

  static Sums load_sums(const std::uint16_t* at) { return vld1q_u16(at); }
  static void store_sums(std::uint16_t* at, Sums x) { vst1q_u16(at, x); }
  static Sums add_sums(Sums a, Sums b) { return vaddq_u16(a, b); }

  static Sums bytes(const std::uint8_t* at) { return vmovl_u8(vld1_u8(at)); }
  static Sums byte_pairs(const std::uint8_t* at) { return vpaddlq_u8(vld1q_u8(at)); }
  static Sums even_bytes(const std::uint8_t* at) {
    return vandq_u16(vreinterpretq_u16_u8(vld1q_u8(at)), vdupq_n_u16(0xFF));
  }
  static Sums pairs(Sums a, Sums b) {
    return vcombine_u16(vmovn_u32(vpaddlq_u16(a)), vmovn_u32(vpaddlq_u16(b)));
  }
  static Sums evens(Sums a, Sums b) { return vuzpq_u16(a, b).val[0]; }
};

}  // namespace

void warp(const WarpArgs& a) {
  tiles::Warp<Simd> tiles(a);
  tiles.run();
}

}  // namespace mien::kernels::MIEN_TIER
