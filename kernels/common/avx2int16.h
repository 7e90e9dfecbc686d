// The multiply-add of the avx2int16 tier.
#pragma once

#include <immintrin.h>

namespace mien::kernels::avx2int16 {
namespace {

struct Pairs {
  // Adds the products of two 16-bit integers to each lane.
  static __m256i add(__m256i sum, __m256i value, __m256i weight) {
    return _mm256_add_epi32(sum, _mm256_madd_epi16(value, weight));
  }
};

}  // namespace
}  // namespace mien::kernels::avx2int16
