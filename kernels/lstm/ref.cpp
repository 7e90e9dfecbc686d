// The reference kernel of lstm.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double sigmoid(double x) { return 1.0 / (1.0 + std::exp(-x)); }

float flushed(double x) { return std::abs(x) < kLstmFlush ? 0.0f : static_cast<float>(x); }

double gate(const LstmArgs& a, std::int32_t output) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{a.in_elems} + a.hidden;
  const std::int32_t outputs = 4 * a.hidden;
  double sum = half_to_float(a.bias[output]);
  for (std::int32_t k = 0; k < a.in_elems; ++k) {
    sum += panel_weight(a.weights, outputs, reduction, output, k) * static_cast<double>(a.x[k]);
  }
  for (std::int32_t k = 0; k < a.hidden; ++k) {
    sum += panel_weight(a.weights, outputs, reduction, output, a.in_elems + k) *
           static_cast<double>(a.h[k]);
  }
  return sum;
}

}  // namespace

void lstm(const LstmArgs& a) {
  for (std::int32_t output = 0; output < 4 * a.hidden; ++output) {
    a.gates[output] = static_cast<float>(gate(a, output));
  }
  for (std::int32_t j = 0; j < a.hidden; ++j) {
    const double i = sigmoid(a.gates[j]);
    const double f = sigmoid(a.gates[a.hidden + j]);
    const double g = std::tanh(static_cast<double>(a.gates[2 * a.hidden + j]));
    const double o = sigmoid(a.gates[3 * a.hidden + j]);
    a.c[j] = flushed(f * static_cast<double>(a.c[j]) + i * g);
    a.h[j] = flushed(o * std::tanh(static_cast<double>(a.c[j])));
    a.y[j] = a.h[j];
  }
}

}  // namespace mien::kernels::ref
