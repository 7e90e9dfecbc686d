// The wasm tier of lstm.
#include "kernels/common/wasm_matvec.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

Vec flushed(Vec x) { return only(wasm_f32x4_ge(wasm_f32x4_abs(x), splat(kLstmFlush)), x); }

}  // namespace

void lstm(const LstmArgs& a) {
  matvec({a.x, a.in_elems, a.h, a.hidden}, a.weights, a.bias, {}, 4 * a.hidden, a.gates);
  for (std::int32_t j = 0; j < a.hidden; j += kLanes) {
    const Vec i = sigmoid(load(a.gates + j));
    const Vec f = sigmoid(load(a.gates + a.hidden + j));
    const Vec g = tanh(load(a.gates + 2 * a.hidden + j));
    const Vec o = sigmoid(load(a.gates + 3 * a.hidden + j));
    const Vec c = flushed(add_product(wasm_f32x4_mul(i, g), f, load(a.c + j)));
    const Vec h = flushed(wasm_f32x4_mul(o, tanh(c)));
    store(a.c + j, c);
    store(a.h + j, h);
    store(a.y + j, h);
  }
}

}  // namespace mien::kernels::wasm
