// fma_peak of tiers that multiply integers.
#pragma once

#include "kernels/fma_peak/fma_peak.h"

namespace mien::kernels {
namespace {

// Vector::Sum is the vector of sums. kSums independent sums keep both multipliers busy: throughput
// 2 per cycle, latency 5 cycles, and spare. Vector::multiply_add adds kProducts products;
// Vector::store writes 8 floats.
template <class Vector>
void integer_peak(const FmaPeakArgs& a) {
  using Sum = typename Vector::Sum;
  Sum sum[Vector::kSums];
  for (int k = 0; k < Vector::kSums; ++k) {
    sum[k] = Vector::all(static_cast<int>(a.rounds % 512) + k);
  }
  const Sum factor = Vector::all(0x30003);  // 3 in both halves
  // Unrolled by hand, because gcc 12 copies all sums in every iteration of a loop.
  constexpr int kUnrolled = 8;
  const std::int64_t turns = (a.rounds + kUnrolled - 1) / kUnrolled;
  for (std::int64_t i = 0; i < turns; ++i) {
#pragma GCC unroll 8
    for (int round = 0; round < kUnrolled; ++round) {
      for (Sum& one : sum) {
        one = Vector::multiply_add(one, one, factor);
      }
    }
  }
  Sum total = Vector::all(0);
  for (const Sum& one : sum) {
    total = Vector::add(total, one);
  }
  // The sums wrap around; keep some bits that depend on all of them.
  Vector::store(Vector::bit_or(Vector::bit_and(total, Vector::all(62)), Vector::all(1)), a.y);
  *a.macs = turns * kUnrolled * Vector::kSums * Vector::kProducts;
}

}  // namespace
}  // namespace mien::kernels
