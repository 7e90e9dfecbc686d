// Neighbours of 16 close positions are permuted out of whole rows, because a gather takes longer
// than loading several rows.
#include "kernels/common/avx512.h"
#include "kernels/families.h"
#include "kernels/image/loads_beyond.h"
#include "kernels/image/tiles.h"

namespace mien::kernels::avx512 {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = 16;
  using Vec = avx512::Vec;
  using Ints = __m512i;

  static Vec splat(float x) { return _mm512_set1_ps(x); }
  static Vec load(const float* at) { return _mm512_loadu_ps(at); }
  static Vec count_from(float first) {
    return _mm512_add_ps(splat(first),
                         _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  }
  static Vec fma(Vec sum, Vec a, Vec b) { return _mm512_fmadd_ps(a, b, sum); }
  static Vec sub(Vec a, Vec b) { return _mm512_sub_ps(a, b); }
  static Vec min(Vec a, Vec b) { return _mm512_min_ps(a, b); }
  static Vec max(Vec a, Vec b) { return _mm512_max_ps(a, b); }
  static Vec floor(Vec x) {
    return _mm512_roundscale_ps(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  }
  static Ints equal(Vec a, Vec b) {
    return _mm512_movm_epi32(_mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ));
  }
  // Comparisons with NaN are false.
  static Vec finite_or_0(Vec x) {
    return _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(_mm512_abs_ps(x), splat(3.0e38f), _CMP_LE_OQ), x);
  }
  static Ints to_ints(Vec x) { return _mm512_cvtps_epi32(x); }
  static void store(std::int32_t* at, Ints x) { _mm512_storeu_si512(at, x); }

  // The weight of a sample in the low 16 bits, that of the next sample in the high 16 bits.
  using Weights = Ints;
  static Weights weights_of(Vec across) {
    const Ints next = to_ints(_mm512_mul_ps(across, splat(tiles::kOne)));
    const Ints both = _mm512_sub_epi32(_mm512_slli_epi32(next, 16), next);
    return _mm512_add_epi32(both, _mm512_set1_epi32(tiles::kOne));
  }

  // The positions of a vector lie on a line, so its first and last lanes are the extremes.
  struct Ends {
    std::int32_t low, high;
    Ends() = default;
    explicit Ends(Ints x) {
      const std::int32_t first = _mm512_cvtsi512_si32(x);
      const std::int32_t last = _mm_extract_epi32(_mm512_extracti32x4_epi32(x, 3), 3);
      low = std::min(first, last);
      high = std::max(first, last);
    }
  };

  class Neighbours {
   public:
    using Reach = tiles::Gathered<Simd>::Reach;

    Neighbours() = default;
    Neighbours(Vec column, Vec row, std::int32_t stride, Vec across, Reach)
        : rows_(to_ints(row)), weights_(weights_of(across)), stride_(stride), height_(rows_) {
      const Ints columns = to_ints(column);
      const Ends width(columns);
      is_close_ = width.high - width.low < kLoaded - 1 && height_.high - height_.low < kMaxRows;
      first_ = is_close_ ? height_.low * stride + width.low : 0;
      const Ints from = _mm512_sub_epi32(columns, _mm512_set1_epi32(width.low));
      order_ = is_close_ ? _mm512_add_epi32(_mm512_or_si512(from, _mm512_slli_epi32(from, 16)),
                                            _mm512_set1_epi32(1 << 16))
                         : to_ints(fma(column, row, splat(static_cast<float>(stride))));
    }

    template <int kCount>
    void rows_of(const std::uint16_t* const* copies, Vec* upper, Vec* lower) const {
      Ints above[kCount], below[kCount];
      if (is_close_) {
        pick<kCount>(copies, above, below);
      } else {
        for (int c = 0; c < kCount; ++c) {
          above[c] = gather(copies[c]);
          below[c] = gather(copies[c] + stride_);
        }
      }
      for (int c = 0; c < kCount; ++c) {
        upper[c] = _mm512_cvtepi32_ps(above[c]);
        lower[c] = _mm512_cvtepi32_ps(below[c]);
      }
    }

   private:
    static constexpr std::int32_t kLoaded = 32;   // samples of a row
    static constexpr std::int32_t kMaxRows = 20;  // more take longer than two gathers

    // Interpolates each row once: below the positions in this row, above those in the next.
    template <int kCount>
    MIEN_LOADS_BEYOND void pick(const std::uint16_t* const* copies, Ints* above,
                                Ints* below) const {
      for (int c = 0; c < kCount; ++c) {
        above[c] = below[c] = _mm512_setzero_si512();
      }
      Ints number = _mm512_set1_epi32(height_.low);
      __mmask16 before = 0;
      std::ptrdiff_t at = first_;
      for (std::int32_t i = height_.low; i <= height_.high + 1; ++i, at += stride_) {
        const __mmask16 here = _mm512_cmpeq_epi32_mask(rows_, number);
        for (int c = 0; c < kCount; ++c) {
          const Ints row = _mm512_loadu_si512(copies[c] + at);
          const Ints sums = _mm512_madd_epi16(_mm512_permutexvar_epi16(order_, row), weights_);
          below[c] = _mm512_mask_mov_epi32(below[c], before, sums);
          above[c] = _mm512_mask_mov_epi32(above[c], here, sums);
        }
        before = here;
        number = _mm512_add_epi32(number, _mm512_set1_epi32(1));
      }
    }
    [[nodiscard]] Ints gather(const std::uint16_t* base) const {
      return _mm512_madd_epi16(_mm512_i32gather_epi32(order_, base, 2), weights_);
    }

    Ints rows_, weights_;
    Ints order_;  // permutation of the loaded pairs, or their index in a copy
    std::int32_t stride_, first_;
    Ends height_;
    bool is_close_;
  };

  static void store_rgb(float* at, Vec r, Vec g, Vec b) {
    // Places red and green, then blue, in each third of the output.
    const auto third = [&](int first, Ints red_green, Ints blue) {
      const Vec rg = _mm512_permutex2var_ps(r, red_green, g);
      _mm512_storeu_ps(at + first, _mm512_permutex2var_ps(rg, blue, b));
    };
    third(0, _mm512_setr_epi32(0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5),
          _mm512_setr_epi32(0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15));
    third(16, _mm512_setr_epi32(21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26),
          _mm512_setr_epi32(0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15));
    third(32, _mm512_setr_epi32(0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0),
          _mm512_setr_epi32(26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31));
  }

  static constexpr std::int32_t kSums = 32;
  using Sums = __m512i;

  MIEN_LOADS_BEYOND static Sums load_sums(const std::uint16_t* at) {
    return _mm512_loadu_si512(at);
  }
  static void store_sums(std::uint16_t* at, Sums x) { _mm512_storeu_si512(at, x); }
  static Sums add_sums(Sums a, Sums b) { return _mm512_add_epi16(a, b); }

  static Sums bytes(const std::uint8_t* at) {
    return _mm512_cvtepu8_epi16(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(at)));
  }
  static Sums both_bytes(const std::uint8_t* at) { return _mm512_loadu_si512(at); }
  static Sums byte_pairs(const std::uint8_t* at) {
    return _mm512_maddubs_epi16(both_bytes(at), _mm512_set1_epi8(1));
  }
  static Sums even_bytes(const std::uint8_t* at) {
    return _mm512_and_si512(both_bytes(at), _mm512_set1_epi16(0xFF));
  }

  static Sums joined(__m512i a, __m512i b) {
    return _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi32_epi16(a)),
                              _mm512_cvtepi32_epi16(b), 1);
  }
  static Sums pairs(Sums a, Sums b) {
    const __m512i ones = _mm512_set1_epi16(1);
    return joined(_mm512_madd_epi16(a, ones), _mm512_madd_epi16(b, ones));
  }
  static Sums evens(Sums a, Sums b) { return joined(a, b); }
};

}  // namespace

void warp(const WarpArgs& a) {
  tiles::Warp<Simd> tiles(a);
  tiles.run();
}

}  // namespace mien::kernels::avx512
