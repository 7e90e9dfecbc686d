// The avx512 tier of lstm.
#include "kernels/common/avx512_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::avx512 {
namespace {

Vec flushed(Vec x) {
  return _mm512_maskz_mov_ps(
      _mm512_cmp_ps_mask(_mm512_abs_ps(x), _mm512_set1_ps(kLstmFlush), _CMP_GE_OQ), x);
}

}  // namespace

void lstm(const LstmArgs& a) {
  const ActivationSpec none;
  matvec({{a.x, a.in_elems, a.h, a.hidden}, a.weights, a.bias, none, 4 * a.hidden, a.gates});
  for (std::int32_t j = 0; j < a.hidden; j += kPanel) {
    const __mmask16 lanes = first_lanes(a.hidden - j);
    const auto gate = [&](std::int32_t which) {
      return _mm512_maskz_loadu_ps(lanes, a.gates + which * a.hidden + j);
    };
    const Vec i = sigmoid(gate(0)), f = sigmoid(gate(1)), g = tanh(gate(2)), o = sigmoid(gate(3));
    const Vec before = _mm512_maskz_loadu_ps(lanes, a.c + j);
    const Vec c = flushed(_mm512_fmadd_ps(f, before, _mm512_mul_ps(i, g)));
    const Vec h = flushed(_mm512_mul_ps(o, tanh(c)));
    _mm512_mask_storeu_ps(a.c + j, lanes, c);
    _mm512_mask_storeu_ps(a.h + j, lanes, h);
    _mm512_mask_storeu_ps(a.y + j, lanes, h);
  }
}

}  // namespace mien::kernels::avx512
