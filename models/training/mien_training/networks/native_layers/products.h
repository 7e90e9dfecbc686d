// Products of a map of few channels with vectors of many channels. A unit is the number of
// consecutive terms that one instruction sums: one of fp32, two of bfloat16.
#pragma once

#include <vector>

#include "norm.h"

namespace mien::training {

template <typename T>
struct Terms;

template <>
struct Terms<float> {
  using Unit = float;
  using Vector = Lanes;
  static constexpr std::size_t kCount = 1;
  static constexpr Unit kOnes = 1.0f;

  static Vector joined(const Lanes* values) { return *values; }
  static Lanes plus(Lanes sum, Vector a, Unit b) { return sum + a * b; }
};

// Each lane has the first value in its lower half and the second in its upper half.
template <>
struct Terms<BFloat16> {
  using Unit = std::uint32_t;
  using Vector = Words;
  static constexpr std::size_t kCount = 2;
  static constexpr Unit kOnes = 0x3f803f80;

  static Vector joined(const Lanes* values) {
    const Lanes first = widened(narrowed(values[0])), second = widened(narrowed(values[1]));
    return std::bit_cast<Words>(first) >> 16 | std::bit_cast<Words>(second);
  }
  static Lanes plus(Lanes sum, Vector a, Unit b) {
    const Words both = Words{} + b;
#ifdef __AVX512BF16__
    return std::bit_cast<Lanes>(_mm512_dpbf16_ps(
        std::bit_cast<__m512>(sum), std::bit_cast<__m512bh>(a), std::bit_cast<__m512bh>(both)));
#else
    const Words upper = Words{} + 0xffff0000u;
    return sum + std::bit_cast<Lanes>(a << 16) * std::bit_cast<Lanes>(both << 16) +
           std::bit_cast<Lanes>(a & upper) * std::bit_cast<Lanes>(both & upper);
#endif
  }
};

template <typename T>
using Unit = typename Terms<T>::Unit;
template <typename T>
using Vector = typename Terms<T>::Vector;
template <typename T>
constexpr std::size_t kTerms = Terms<T>::kCount;

template <typename T>
constexpr std::size_t units(std::size_t values) {
  return (values + kTerms<T> - 1) / kTerms<T>;
}

// Combines the vectors value(k), k < count, to units.
template <typename T, std::size_t kMost, typename Value>
std::array<Vector<T>, kMost> joined(std::size_t count, Value value) {
  std::array<Vector<T>, kMost> out = {};
  for (std::size_t k = 0; k < count; k += kTerms<T>) {
    std::array<Lanes, kTerms<T>> values = {};
    for (std::size_t j = 0; j < kTerms<T>; ++j) {
      values[j] = value(k + j);
    }
    out[k / kTerms<T>] = Terms<T>::joined(values.data());
  }
  return out;
}

// out[p] = (out[p] +) sum over k < count of x[p][k] weights[k], for several pixels at a time, which
// hides the latency of the sums. count is a multiple of a unit.
template <std::size_t kTogether, typename T>
std::size_t product_of(const T* x, std::size_t stride, std::size_t count, const Vector<T>* weights,
                       std::size_t begin, std::size_t pixels, Lanes* out, std::size_t out_stride,
                       bool add) {
  std::size_t p = begin;
  for (; p + kTogether <= pixels; p += kTogether) {
    std::array<Lanes, kTogether> sums = {};
    for (std::size_t k = 0; k < count; k += kTerms<T>) {
      for (std::size_t j = 0; j < kTogether; ++j) {
        Unit<T> unit;
        std::memcpy(&unit, x + (p + j) * stride + k, sizeof unit);
        sums[j] = Terms<T>::plus(sums[j], weights[k / kTerms<T>], unit);
      }
    }
    for (std::size_t j = 0; j < kTogether; ++j) {
      Lanes& to = out[(p + j) * out_stride];
      to = add ? to + sums[j] : sums[j];
    }
  }
  return p;
}

template <typename T>
void product(const T* x, std::size_t stride, std::size_t count, const Vector<T>* weights,
             std::size_t pixels, Lanes* out, std::size_t out_stride, bool add) {
  std::size_t p = product_of<8>(x, stride, count, weights, 0, pixels, out, out_stride, add);
  p = product_of<4>(x, stride, count, weights, p, pixels, out, out_stride, add);
  product_of<1>(x, stride, count, weights, p, pixels, out, out_stride, add);
}

// The pixels of a row, combined to units, for sums over pixels. The last unit of a row, and
// channels up to whole vectors, are filled with zeros.
template <typename T>
class Along {
 public:
  Along(std::size_t rows, std::size_t width, std::size_t channels)
      : rows_(rows),
        width_(width),
        channels_(channels),
        vectors_((channels + kLanes - 1) / kLanes),
        values_(rows * units<T>(width) * vectors_) {}

  // Reads pixels(row, column, vector).
  template <typename Pixels>
  void fill(Pixels pixels) {
    auto to = values_.begin();
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t column = 0; column < width_; column += kTerms<T>) {
        for (std::size_t v = 0; v < vectors_; ++v) {
          std::array<Lanes, kTerms<T>> values = {};
          for (std::size_t j = 0; j < std::min(kTerms<T>, width_ - column); ++j) {
            values[j] = pixels(row, column + j, v);
          }
          *to++ = Terms<T>::joined(values.data());
        }
      }
    }
  }
  void read(const T* x) {  // [rows][width][channels]
    fill([&](std::size_t row, std::size_t column, std::size_t v) {
      const std::size_t c = v * kLanes;
      return load_some(x + (row * width_ + column) * channels_ + c,
                       std::min(kLanes, channels_ - c));
    });
  }

  std::size_t vectors() const { return vectors_; }
  std::size_t units_of_row() const { return units<T>(width_); }
  std::size_t units_of_all() const { return rows_ * units_of_row(); }
  const Vector<T>* row(std::size_t row) const {
    return values_.data() + row * units_of_row() * vectors_;
  }

 private:
  std::size_t rows_, width_, channels_, vectors_;
  std::vector<Vector<T>> values_;
};

// totals[k] += sum over pixels of x[p][k] y[p], for k < count, a multiple of 8. Both have the
// layout of Along: x [units] of x_vectors, y every y_vectors-th.
template <typename T>
void outer(const Vector<T>* x, std::size_t x_vectors, std::size_t count, const Vector<T>* y,
           std::size_t y_vectors, std::size_t length, Lanes* totals) {
  constexpr std::size_t kSummed = 8;  // stay in registers
  for (std::size_t k = 0; k < count; k += kSummed) {
    std::array<Lanes, kSummed> sums;
    std::copy_n(totals + k, kSummed, sums.begin());
    for (std::size_t u = 0; u < length; ++u) {
      const auto* from = reinterpret_cast<const Unit<T>*>(x + u * x_vectors) + k;
      for (std::size_t j = 0; j < kSummed; ++j) {
        sums[j] = Terms<T>::plus(sums[j], y[u * y_vectors], from[j]);
      }
    }
    std::copy(sums.begin(), sums.end(), totals + k);
  }
}

}  // namespace mien::training
