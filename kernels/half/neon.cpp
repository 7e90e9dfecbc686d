#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {

void half_to_float(const HalfToFloatArgs& a) {
  std::int32_t i = 0;
  for (; i + kLanes <= a.n; i += kLanes) {
    vst1q_f32(a.y + i, load_half(a.x + i));
  }
  for (; i < a.n; ++i) {
    vst1q_lane_f32(a.y + i, vcvt_f32_f16(vreinterpret_f16_u16(vdup_n_u16(a.x[i]))), 0);
  }
}

void float_to_half(const FloatToHalfArgs& a) {
  std::int32_t i = 0;
  for (; i + kLanes <= a.n; i += kLanes) {
    vst1_u16(a.y + i, vreinterpret_u16_f16(vcvt_f16_f32(vld1q_f32(a.x + i))));
  }
  for (; i < a.n; ++i) {
    vst1_lane_u16(a.y + i, vreinterpret_u16_f16(vcvt_f16_f32(splat(a.x[i]))), 0);
  }
}

}  // namespace mien::kernels::MIEN_TIER
