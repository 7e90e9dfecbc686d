// An LSTM layer over whole sequences, forwards and backwards, where PyTorch on a CPU spends most of
// its time between small matrix products. Arrays are fp32, time-major: [steps][batch][...], gates
// i, f, g, o.
#include <algorithm>
#include <cstddef>
#include <cstring>

namespace {

constexpr std::size_t kLanes = 16;
using Vector [[gnu::vector_size(4 * kLanes), gnu::aligned(4)]] = float;

Vector load(const float* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

void store(float* to, Vector v) { std::memcpy(to, &v, sizeof v); }

// c[row][0 .. 2 kLanes) += a[row][k] b[k][0 .. 2 kLanes)
template <std::size_t kRows>
void multiply_tile(const float* a, std::size_t a_stride, const float* b, std::size_t b_stride,
                   std::size_t depth, float* c, std::size_t c_stride) {
  Vector sums[kRows][2];
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t j = 0; j < 2; ++j) {
      sums[r][j] = load(c + r * c_stride + j * kLanes);
    }
  }
  for (std::size_t k = 0; k < depth; ++k) {
    const Vector b0 = load(b + k * b_stride), b1 = load(b + k * b_stride + kLanes);
    for (std::size_t r = 0; r < kRows; ++r) {
      sums[r][0] += a[r * a_stride + k] * b0;
      sums[r][1] += a[r * a_stride + k] * b1;
    }
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t j = 0; j < 2; ++j) {
      store(c + r * c_stride + j * kLanes, sums[r][j]);
    }
  }
}

// c [rows][columns] += a [rows][depth] b [depth][columns]; columns are a multiple of 2 kLanes.
void multiply_add(const float* a, const float* b, float* c, std::size_t rows, std::size_t depth,
                  std::size_t columns) {
  for (std::size_t j = 0; j < columns; j += 2 * kLanes) {
    std::size_t r = 0;
    for (; r + 12 <= rows; r += 12) {
      multiply_tile<12>(a + r * depth, depth, b + j, columns, depth, c + r * columns + j, columns);
    }
    for (; r + 4 <= rows; r += 4) {
      multiply_tile<4>(a + r * depth, depth, b + j, columns, depth, c + r * columns + j, columns);
    }
    for (; r < rows; ++r) {
      multiply_tile<1>(a + r * depth, depth, b + j, columns, depth, c + r * columns + j, columns);
    }
  }
}

// e^x by 2^n times a polynomial of the rest (relative error below 3e-7 for |x| < 87).
Vector exponential(Vector x) {
  using Integers [[gnu::vector_size(4 * kLanes)]] = int;
  x = x < -87.0f ? Vector{} - 87.0f : x > 87.0f ? Vector{} + 87.0f : x;
  const Vector scaled = x * 1.44269504f;
  const Integers n = __builtin_convertvector(
      scaled + (scaled < 0.0f ? Vector{} - 0.5f : Vector{} + 0.5f), Integers);
  const Vector whole = __builtin_convertvector(n, Vector);
  const Vector r = (x - whole * 0.693359375f) + whole * 2.12194440e-4f;
  Vector p = r * 1.9875691500e-4f + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = p * r * r + r + 1.0f;
  const Integers power = (n + 127) << 23;
  Vector two_to_n;
  std::memcpy(&two_to_n, &power, sizeof power);
  return p * two_to_n;
}

Vector sigmoid(Vector x) { return 1.0f / (1.0f + exponential(-x)); }
Vector hyperbolic_tangent(Vector x) { return 2.0f * sigmoid(2.0f * x) - 1.0f; }

}  // namespace

// gates: in, what the inputs and the bias give [steps][batch][4 hidden]; out, the gates'
// activations. weight [hidden][4 hidden]. h, c [steps + 1][batch][hidden], the first step of both
// zero; hidden is a multiple of 32.
extern "C" void lstm_forward(float* gates, const float* weight, std::size_t steps,
                             std::size_t batch, std::size_t hidden, float* h, float* c) {
  const std::size_t state = batch * hidden;
  for (std::size_t t = 0; t < steps; ++t) {
    float* now = gates + 4 * t * state;
    multiply_add(h + t * state, weight, now, batch, hidden, 4 * hidden);
    for (std::size_t n = 0; n < batch; ++n) {
      for (std::size_t j = 0; j < hidden; j += kLanes) {
        float* gate = now + 4 * n * hidden + j;
        const std::size_t at = t * state + n * hidden + j;
        const Vector i = sigmoid(load(gate)), f = sigmoid(load(gate + hidden));
        const Vector g = hyperbolic_tangent(load(gate + 2 * hidden)),
                     o = sigmoid(load(gate + 3 * hidden));
        const Vector cell = f * load(c + at) + i * g;
        store(gate, i), store(gate + hidden, f), store(gate + 2 * hidden, g),
            store(gate + 3 * hidden, o);
        store(c + at + state, cell);
        store(h + at + state, o * hyperbolic_tangent(cell));
      }
    }
  }
}

// gates: in, their activations; out, the gradient before the activations. weight [4
// hidden][hidden], dh [steps][batch][hidden] the gradient of h, which is overwritten; dc
// [batch][hidden] zeros.
extern "C" void lstm_backward(float* gates, const float* weight, std::size_t steps,
                              std::size_t batch, std::size_t hidden, const float* c, float* dh,
                              float* dc) {
  const std::size_t state = batch * hidden;
  for (std::size_t t = steps; t-- > 0;) {
    float* now = gates + 4 * t * state;
    for (std::size_t n = 0; n < batch; ++n) {
      for (std::size_t j = 0; j < hidden; j += kLanes) {
        float* gate = now + 4 * n * hidden + j;
        const std::size_t within = n * hidden + j, at = t * state + within;
        const Vector i = load(gate), f = load(gate + hidden), g = load(gate + 2 * hidden),
                     o = load(gate + 3 * hidden);
        const Vector tangent = hyperbolic_tangent(load(c + at + state)), out = load(dh + at);
        const Vector cell = load(dc + within) + out * o * (1.0f - tangent * tangent);
        store(gate, cell * g * i * (1.0f - i));
        store(gate + hidden, cell * load(c + at) * f * (1.0f - f));
        store(gate + 2 * hidden, cell * i * (1.0f - g * g));
        store(gate + 3 * hidden, out * tangent * o * (1.0f - o));
        store(dc + within, cell * f);
      }
    }
    if (t > 0) {
      multiply_add(now, weight, dh + (t - 1) * state, batch, 4 * hidden, hidden);
    }
  }
}
