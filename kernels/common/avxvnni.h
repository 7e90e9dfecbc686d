// The multiply-adds of the avxvnni tier.
#pragma once

#include <immintrin.h>

namespace mien::kernels::avxvnni {
namespace {

struct Pairs {
  // Adds the products of two 16-bit integers to each lane.
  static __m256i add(__m256i sum, __m256i value, __m256i weight) {
    return _mm256_dpwssd_avx_epi32(sum, value, weight);
  }
};

struct Quads {
  // Adds the products of four unsigned 8-bit integers with four signed ones to each lane.
  static __m256i add(__m256i sum, __m256i value, __m256i weight) {
    return _mm256_dpbusd_avx_epi32(sum, value, weight);
  }
};

}  // namespace
}  // namespace mien::kernels::avxvnni
