// The neon and neon32 tiers of lstm.
#include "kernels/common/neon_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

Vec flushed(Vec x) { return only(vcgeq_f32(vabsq_f32(x), splat(kLstmFlush)), x); }

}  // namespace

void lstm(const LstmArgs& a) {
  matvec({a.x, a.in_elems, a.h, a.hidden}, a.weights, a.bias, {}, 4 * a.hidden, a.gates);
  for (std::int32_t j = 0; j < a.hidden; j += kLanes) {
    const Vec i = sigmoid(vld1q_f32(a.gates + j));
    const Vec f = sigmoid(vld1q_f32(a.gates + a.hidden + j));
    const Vec g = tanh(vld1q_f32(a.gates + 2 * a.hidden + j));
    const Vec o = sigmoid(vld1q_f32(a.gates + 3 * a.hidden + j));
    const Vec c = flushed(fma(vmulq_f32(i, g), f, vld1q_f32(a.c + j)));
    const Vec h = flushed(vmulq_f32(o, tanh(c)));
    vst1q_f32(a.c + j, c);
    vst1q_f32(a.h + j, h);
    vst1q_f32(a.y + j, h);
  }
}

}  // namespace mien::kernels::MIEN_TIER
