// The avx2 tier of lstm.
#include "kernels/common/avx2_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

Vec flushed(Vec x) {
  const Vec magnitude = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x);
  return _mm256_and_ps(x, _mm256_cmp_ps(magnitude, _mm256_set1_ps(kLstmFlush), _CMP_GE_OQ));
}

}  // namespace

void lstm(const LstmArgs& a) {
  matvec({a.x, a.in_elems, a.h, a.hidden}, a.weights, a.bias, {}, 4 * a.hidden, a.gates);
  for (std::int32_t j = 0; j < a.hidden; j += kLanes) {
    const Vec i = sigmoid(_mm256_loadu_ps(a.gates + j));
    const Vec f = sigmoid(_mm256_loadu_ps(a.gates + a.hidden + j));
    const Vec g = tanh(_mm256_loadu_ps(a.gates + 2 * a.hidden + j));
    const Vec o = sigmoid(_mm256_loadu_ps(a.gates + 3 * a.hidden + j));
    const Vec c = flushed(_mm256_fmadd_ps(f, _mm256_loadu_ps(a.c + j), _mm256_mul_ps(i, g)));
    const Vec h = flushed(_mm256_mul_ps(o, tanh(c)));
    _mm256_storeu_ps(a.c + j, c);
    _mm256_storeu_ps(a.h + j, h);
    _mm256_storeu_ps(a.y + j, h);
  }
}

}  // namespace mien::kernels::avx2
