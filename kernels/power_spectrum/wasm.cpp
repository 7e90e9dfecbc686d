// The real signal as one of n/2 complex numbers, z_j = x_2j + i x_2j+1 (Cooley, Lewis, Welch 1970).
// Their transform has two steps: with j = 4 r + lane and k = p + rows q, each lane is transformed
// by itself over r, its results are turned by e^(-2 pi i lane p / (n/2)), and a 4 point transform
// over the lanes, which a transposition has made rows, gives q.
#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

constexpr std::int32_t kMostRows = PowerSpectrumArgs::kLargest / 2 / kLanes;

struct Complex {
  Vec re, im;
};

Complex add(const Complex& a, const Complex& b) {
  return {wasm_f32x4_add(a.re, b.re), wasm_f32x4_add(a.im, b.im)};
}
Complex subtract(const Complex& a, const Complex& b) {
  return {wasm_f32x4_sub(a.re, b.re), wasm_f32x4_sub(a.im, b.im)};
}
Complex multiply(const Complex& a, const Complex& b) {
  return {wasm_f32x4_sub(wasm_f32x4_mul(a.re, b.re), wasm_f32x4_mul(a.im, b.im)),
          wasm_f32x4_add(wasm_f32x4_mul(a.re, b.im), wasm_f32x4_mul(a.im, b.re))};
}

// e^(-2 pi i turn / n)
struct Twiddles {
  const float* table;
  std::int32_t n;

  [[nodiscard]] float re(std::int32_t turn) const { return table[std::ptrdiff_t{2} * turn]; }
  [[nodiscard]] float im(std::int32_t turn) const { return table[std::ptrdiff_t{2} * turn + 1]; }
  [[nodiscard]] Complex everywhere(std::int32_t turn) const {
    return {splat(re(turn)), splat(im(turn))};
  }
  // Of turns 0, step, 2 step ..
  [[nodiscard]] Complex lanes(std::int32_t step) const {
    float re_of[kLanes];
    float im_of[kLanes];
    for (std::int32_t lane = 0; lane < kLanes; ++lane) {
      re_of[lane] = re(lane * step);
      im_of[lane] = im(lane * step);
    }
    return {load(re_of), load(im_of)};
  }
};

// Rows in bit-reversed order -> their transform (Cooley, Tukey 1965).
void transform_rows(Complex* rows, std::int32_t count, const Twiddles& twiddles) {
  for (std::int32_t half = 1; half < count; half *= 2) {
    for (std::int32_t p = 0; p < half; ++p) {
      const Complex turn = twiddles.everywhere(p * (twiddles.n / (2 * half)));
      for (std::int32_t first = p; first < count; first += 2 * half) {
        const Complex even = rows[first];
        const Complex odd = multiply(rows[first + half], turn);
        rows[first] = add(even, odd);
        rows[first + half] = subtract(even, odd);
      }
    }
  }
}

std::int32_t reversed_bits(std::int32_t value, std::int32_t count) {
  std::int32_t out = 0;
  for (std::int32_t bit = 1; bit < count; bit *= 2) {
    out = 2 * out + (value & 1);
    value /= 2;
  }
  return out;
}

// 8 floats -> the 4 at even places and the 4 at odd ones.
Complex deinterleaved(const float* x) {
  const Vec a = load(x), b = load(x + kLanes);
  return {wasm_i32x4_shuffle(a, b, 0, 2, 4, 6), wasm_i32x4_shuffle(a, b, 1, 3, 5, 7)};
}

void transpose(Vec (&v)[kLanes]) {
  const Vec low0 = wasm_i32x4_shuffle(v[0], v[1], 0, 4, 1, 5);
  const Vec high0 = wasm_i32x4_shuffle(v[0], v[1], 2, 6, 3, 7);
  const Vec low1 = wasm_i32x4_shuffle(v[2], v[3], 0, 4, 1, 5);
  const Vec high1 = wasm_i32x4_shuffle(v[2], v[3], 2, 6, 3, 7);
  v[0] = wasm_i32x4_shuffle(low0, low1, 0, 1, 4, 5);
  v[1] = wasm_i32x4_shuffle(low0, low1, 2, 3, 6, 7);
  v[2] = wasm_i32x4_shuffle(high0, high1, 0, 1, 4, 5);
  v[3] = wasm_i32x4_shuffle(high0, high1, 2, 3, 6, 7);
}

void transpose(Complex* block) {
  Vec re[kLanes];
  Vec im[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    re[i] = block[i].re;
    im[i] = block[i].im;
  }
  transpose(re);
  transpose(im);
  for (int i = 0; i < kLanes; ++i) {
    block[i] = {re[i], im[i]};
  }
}

// z_0 .. z_(half-1) and z_half = z_0, transformed.
struct Spectrum {
  float re[PowerSpectrumArgs::kLargest / 2 + kLanes];
  float im[PowerSpectrumArgs::kLargest / 2 + kLanes];
};

void transform(const PowerSpectrumArgs& a, const Twiddles& twiddles, Spectrum& z) {
  const std::int32_t half = a.n / 2;
  const std::int32_t count = half / kLanes;
  Complex rows[kMostRows];
  for (std::int32_t r = 0; r < count; ++r) {
    rows[reversed_bits(r, count)] = deinterleaved(a.x + std::ptrdiff_t{2} * kLanes * r);
  }
  transform_rows(rows, count, twiddles);
  for (std::int32_t p = 0; p < count; ++p) {
    rows[p] = multiply(rows[p], twiddles.lanes(2 * p));
  }
  for (std::int32_t first = 0; first < count; first += kLanes) {
    transpose(rows + first);
    Complex lanes[kLanes];
    for (std::int32_t lane = 0; lane < kLanes; ++lane) {
      lanes[reversed_bits(lane, kLanes)] = rows[first + lane];
    }
    transform_rows(lanes, kLanes, twiddles);
    for (std::int32_t q = 0; q < kLanes; ++q) {
      store(z.re + first + q * count, lanes[q].re);
      store(z.im + first + q * count, lanes[q].im);
    }
  }
  z.re[half] = z.re[0];
  z.im[half] = z.im[0];
}

Vec reversed(const float* last) {
  const Vec ascending = load(last - kLanes + 1);
  return wasm_i32x4_shuffle(ascending, ascending, 3, 2, 1, 0);
}

}  // namespace

// The spectrum of x at k comes from that of z at k and at half - k: of the even places its sum, of
// the odd ones its difference, turned.
void power_spectrum(const PowerSpectrumArgs& a) {
  const Twiddles twiddles = {a.twiddles, a.n};
  const std::int32_t half = a.n / 2;
  Spectrum z = {};
  transform(a, twiddles, z);
  const Vec quarter = splat(0.25f);
  for (std::int32_t k = 0; k < half; k += kLanes) {
    const Complex here = {load(z.re + k), load(z.im + k)};
    const Complex there = {reversed(z.re + half - k), reversed(z.im + half - k)};
    const Complex even = {wasm_f32x4_add(here.re, there.re), wasm_f32x4_sub(here.im, there.im)};
    const Complex odd = {wasm_f32x4_add(here.im, there.im), wasm_f32x4_sub(there.re, here.re)};
    const Complex sum = add(even, multiply(odd, deinterleaved(a.twiddles + 2 * k)));
    const Vec power = add_product(wasm_f32x4_mul(sum.im, sum.im), sum.re, sum.re);
    store(a.y + k, wasm_f32x4_mul(power, quarter));
  }
  const float last = z.re[0] - z.im[0];
  a.y[half] = last * last;
}

}  // namespace mien::kernels::wasm
