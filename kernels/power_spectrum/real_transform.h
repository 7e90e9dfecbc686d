// The power spectrum of tiers with SIMD. It treats the real signal as n/2 complex numbers, z_j =
// x_2j + i x_2j+1 (Cooley, Lewis, Welch 1970), and transforms these in two passes: with j = lanes r
// + lane and k = p + rows q, it transforms each lane over r, multiplies the results by e^(-2 pi i
// lane p / (n/2)), transposes, and transforms over the lanes, which are now rows, to obtain q. All
// code has internal linkage: the linker cannot merge code of different tiers.
//
// A tier supplies `Simd`, with vectors of kLanes floats:
//   Vec; splat, load, store, add, sub, mul
//   add_product(sum, a, b), subtract_product(sum, a, b)
//   deinterleave(const float*, Vec& even, Vec& odd): of 2 kLanes floats
//   transpose(Vec[kLanes]); reversed(Vec)
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/power_spectrum/power_spectrum.h"

namespace mien::kernels {
namespace {

template <class Simd>
class RealTransform {
 public:
  explicit RealTransform(const PowerSpectrumArgs& args) : a_(args), half_(args.n / 2) {}

  // Computes the spectrum of x at k from that of z at k and half - k: even samples give the sum,
  // odd samples the rotated difference.
  void power() {
    transform();
    const Vec quarter = Simd::splat(0.25f);
    for (std::int32_t k = 0; k < half_; k += Simd::kLanes) {
      const Complex here = {Simd::load(re_ + k), Simd::load(im_ + k)};
      const Complex there = {before(re_ + half_ - k), before(im_ + half_ - k)};
      const Complex even = {Simd::add(here.re, there.re), Simd::sub(here.im, there.im)};
      const Complex odd = {Simd::add(here.im, there.im), Simd::sub(there.re, here.re)};
      const Complex sum = add(even, multiply(odd, deinterleaved(a_.twiddles + 2 * k)));
      const Vec power = Simd::add_product(Simd::mul(sum.im, sum.im), sum.re, sum.re);
      Simd::store(a_.y + k, Simd::mul(power, quarter));
    }
    const float last = re_[0] - im_[0];
    a_.y[half_] = last * last;
  }

 private:
  using Vec = typename Simd::Vec;

  struct Complex {
    Vec re, im;
  };

  static Complex add(const Complex& a, const Complex& b) {
    return {Simd::add(a.re, b.re), Simd::add(a.im, b.im)};
  }
  static Complex subtract(const Complex& a, const Complex& b) {
    return {Simd::sub(a.re, b.re), Simd::sub(a.im, b.im)};
  }
  static Complex multiply(const Complex& a, const Complex& b) {
    return {Simd::subtract_product(Simd::mul(a.re, b.re), a.im, b.im),
            Simd::add_product(Simd::mul(a.im, b.re), a.re, b.im)};
  }
  static Complex deinterleaved(const float* x) {
    Complex pairs;
    Simd::deinterleave(x, pairs.re, pairs.im);
    return pairs;
  }
  // The kLanes floats that end at `last`, reversed.
  static Vec before(const float* last) {
    return Simd::reversed(Simd::load(last - Simd::kLanes + 1));
  }

  // e^(-2 pi i turn / n)
  [[nodiscard]] Complex everywhere(std::int32_t turn) const {
    const float* at = a_.twiddles + std::ptrdiff_t{2} * turn;
    return {Simd::splat(at[0]), Simd::splat(at[1])};
  }
  // The same for the turns 0, step, 2 step ..
  [[nodiscard]] Complex lanes(std::int32_t step) const {
    float re[Simd::kLanes], im[Simd::kLanes];
    for (std::ptrdiff_t lane = 0; lane < Simd::kLanes; ++lane) {
      re[lane] = a_.twiddles[2 * lane * step];
      im[lane] = a_.twiddles[2 * lane * step + 1];
    }
    return {Simd::load(re), Simd::load(im)};
  }

  static std::int32_t reversed_bits(std::int32_t value, std::int32_t count) {
    std::int32_t out = 0;
    for (std::int32_t bit = 1; bit < count; bit *= 2) {
      out = 2 * out + (value & 1);
      value /= 2;
    }
    return out;
  }

  // Transforms rows that are in bit-reversed order (Cooley, Tukey 1965).
  void transform_rows(Complex* rows, std::int32_t count) const {
    for (std::int32_t half = 1; half < count; half *= 2) {
      for (std::int32_t p = 0; p < half; ++p) {
        const Complex turn = everywhere(p * (a_.n / (2 * half)));
        for (std::int32_t first = p; first < count; first += 2 * half) {
          const Complex even = rows[first];
          const Complex odd = multiply(rows[first + half], turn);
          rows[first] = add(even, odd);
          rows[first + half] = subtract(even, odd);
        }
      }
    }
  }

  static void transpose(Complex* block) {
    Vec re[Simd::kLanes], im[Simd::kLanes];
    for (std::int32_t i = 0; i < Simd::kLanes; ++i) {
      re[i] = block[i].re;
      im[i] = block[i].im;
    }
    Simd::transpose(re);
    Simd::transpose(im);
    for (std::int32_t i = 0; i < Simd::kLanes; ++i) {
      block[i] = {re[i], im[i]};
    }
  }

  void transform() {
    const std::int32_t count = half_ / Simd::kLanes;
    Complex rows[PowerSpectrumArgs::kMaxSize / 2 / Simd::kLanes];
    for (std::int32_t r = 0; r < count; ++r) {
      rows[reversed_bits(r, count)] = deinterleaved(a_.x + std::ptrdiff_t{2} * Simd::kLanes * r);
    }
    transform_rows(rows, count);
    for (std::int32_t p = 0; p < count; ++p) {
      rows[p] = multiply(rows[p], lanes(2 * p));
    }
    for (std::int32_t first = 0; first < count; first += Simd::kLanes) {
      transpose(rows + first);
      Complex across[Simd::kLanes];
      for (std::int32_t lane = 0; lane < Simd::kLanes; ++lane) {
        across[reversed_bits(lane, Simd::kLanes)] = rows[first + lane];
      }
      transform_rows(across, Simd::kLanes);
      for (std::int32_t q = 0; q < Simd::kLanes; ++q) {
        Simd::store(re_ + first + q * count, across[q].re);
        Simd::store(im_ + first + q * count, across[q].im);
      }
    }
    re_[half_] = re_[0];
    im_[half_] = im_[0];
  }

  // The transform of z: z_0 .. z_(half-1) and z_half = z_0.
  alignas(64) float re_[PowerSpectrumArgs::kMaxSize / 2 + Simd::kLanes] = {};
  alignas(64) float im_[PowerSpectrumArgs::kMaxSize / 2 + Simd::kLanes] = {};
  const PowerSpectrumArgs& a_;
  const std::int32_t half_;
};

}  // namespace
}  // namespace mien::kernels
