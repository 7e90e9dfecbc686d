// The real signal as one of n/2 complex numbers, z_j = x_2j + i x_2j+1 (Cooley, Lewis, Welch 1970).
// Their transform has two steps: with j = 8 r + lane and k = p + rows q, each lane is transformed
// by itself over r, its results are turned by e^(-2 pi i lane p / (n/2)), and an 8 point transform
// over the lanes, which a transposition has made rows, gives q.
#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

constexpr std::int32_t kMostRows = PowerSpectrumArgs::kLargest / 2 / kLanes;

struct Complex {
  Vec re, im;
};

Complex add(Complex a, Complex b) { return {_mm256_add_ps(a.re, b.re), _mm256_add_ps(a.im, b.im)}; }
Complex subtract(Complex a, Complex b) {
  return {_mm256_sub_ps(a.re, b.re), _mm256_sub_ps(a.im, b.im)};
}
Complex multiply(Complex a, Complex b) {
  return {_mm256_fmsub_ps(a.re, b.re, _mm256_mul_ps(a.im, b.im)),
          _mm256_fmadd_ps(a.re, b.im, _mm256_mul_ps(a.im, b.re))};
}

// e^(-2 pi i turn / n)
struct Twiddles {
  const float* table;
  std::int32_t n;

  [[nodiscard]] float re(std::int32_t turn) const { return table[std::ptrdiff_t{2} * turn]; }
  [[nodiscard]] float im(std::int32_t turn) const { return table[std::ptrdiff_t{2} * turn + 1]; }
  [[nodiscard]] Complex everywhere(std::int32_t turn) const {
    return {_mm256_set1_ps(re(turn)), _mm256_set1_ps(im(turn))};
  }
  // Of turns 0, step, 2 step ..
  [[nodiscard]] Complex lanes(std::int32_t step) const {
    alignas(32) float re_of[kLanes];
    alignas(32) float im_of[kLanes];
    for (std::int32_t lane = 0; lane < kLanes; ++lane) {
      re_of[lane] = re(lane * step);
      im_of[lane] = im(lane * step);
    }
    return {_mm256_load_ps(re_of), _mm256_load_ps(im_of)};
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

// 16 floats -> the 8 at even places and the 8 at odd ones.
Complex deinterleaved(const float* x) {
  const Vec a = _mm256_loadu_ps(x);
  const Vec b = _mm256_loadu_ps(x + kLanes);
  const Vec low = _mm256_permute2f128_ps(a, b, 0x20);
  const Vec high = _mm256_permute2f128_ps(a, b, 0x31);
  return {_mm256_shuffle_ps(low, high, 0x88), _mm256_shuffle_ps(low, high, 0xDD)};
}

void transpose(Vec* v) {
  Vec pairs[kLanes];
  for (int i = 0; i < kLanes; i += 2) {
    pairs[i] = _mm256_unpacklo_ps(v[i], v[i + 1]);
    pairs[i + 1] = _mm256_unpackhi_ps(v[i], v[i + 1]);
  }
  Vec fours[kLanes];
  for (int i = 0; i < kLanes; i += 4) {
    fours[i] = _mm256_shuffle_ps(pairs[i], pairs[i + 2], 0x44);
    fours[i + 1] = _mm256_shuffle_ps(pairs[i], pairs[i + 2], 0xEE);
    fours[i + 2] = _mm256_shuffle_ps(pairs[i + 1], pairs[i + 3], 0x44);
    fours[i + 3] = _mm256_shuffle_ps(pairs[i + 1], pairs[i + 3], 0xEE);
  }
  for (int i = 0; i < 4; ++i) {
    v[i] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x20);
    v[i + 4] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x31);
  }
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
  alignas(32) float re[PowerSpectrumArgs::kLargest / 2 + kLanes];
  alignas(32) float im[PowerSpectrumArgs::kLargest / 2 + kLanes];
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
      _mm256_store_ps(z.re + first + q * count, lanes[q].re);
      _mm256_store_ps(z.im + first + q * count, lanes[q].im);
    }
  }
  z.re[half] = z.re[0];
  z.im[half] = z.im[0];
}

Vec reversed(const float* last) {
  const __m256i order = _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0);
  return _mm256_permutevar8x32_ps(_mm256_loadu_ps(last - kLanes + 1), order);
}

}  // namespace

// The spectrum of x at k comes from that of z at k and at half - k: of the even places its sum, of
// the odd ones its difference, turned.
void power_spectrum(const PowerSpectrumArgs& a) {
  const Twiddles twiddles = {a.twiddles, a.n};
  const std::int32_t half = a.n / 2;
  Spectrum z = {};
  transform(a, twiddles, z);
  const Vec quarter = _mm256_set1_ps(0.25f);
  for (std::int32_t k = 0; k < half; k += kLanes) {
    const Complex here = {_mm256_load_ps(z.re + k), _mm256_load_ps(z.im + k)};
    const Complex there = {reversed(z.re + half - k), reversed(z.im + half - k)};
    const Complex even = {_mm256_add_ps(here.re, there.re), _mm256_sub_ps(here.im, there.im)};
    const Complex odd = {_mm256_add_ps(here.im, there.im), _mm256_sub_ps(there.re, here.re)};
    const Complex sum = add(even, multiply(odd, deinterleaved(a.twiddles + 2 * k)));
    const Vec power = _mm256_fmadd_ps(sum.re, sum.re, _mm256_mul_ps(sum.im, sum.im));
    _mm256_storeu_ps(a.y + k, _mm256_mul_ps(power, quarter));
  }
  const float last = z.re[0] - z.im[0];
  a.y[half] = last * last;
}

}  // namespace mien::kernels::avx2
