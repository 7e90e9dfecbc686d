// Neighbours of close positions are picked out of vectors of samples, because a gather takes longer
// than loading several.
#include <cmath>

#include "kernels/common/avx2.h"
#include "kernels/families.h"
#include "kernels/image/loads_beyond.h"
#include "kernels/image/tiles.h"

namespace mien::kernels::avx2 {
namespace {

struct Simd {
  static constexpr std::int32_t kLanes = avx2::kLanes;
  static constexpr int kGroup = 4;    // lanes with a vector of samples of their own
  static constexpr int kLoaded = 8;   // samples of a row
  static constexpr int kMaxRows = 6;  // more take longer than gathers
  using Vec = __m256;
  using Ints = __m256i;

  static Vec splat(float x) { return _mm256_set1_ps(x); }
  static Vec load(const float* at) { return _mm256_loadu_ps(at); }
  static Vec count_from(float first) {
    return _mm256_add_ps(_mm256_set1_ps(first), _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7));
  }
  static Vec fma(Vec sum, Vec a, Vec b) { return _mm256_fmadd_ps(a, b, sum); }
  static Vec sub(Vec a, Vec b) { return _mm256_sub_ps(a, b); }
  static Vec min(Vec a, Vec b) { return _mm256_min_ps(a, b); }
  static Vec max(Vec a, Vec b) { return _mm256_max_ps(a, b); }
  static Vec floor(Vec x) { return _mm256_floor_ps(x); }
  static Ints equal(Vec a, Vec b) { return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_EQ_OQ)); }
  // Comparisons with NaN are false.
  static Vec finite_or_0(Vec x) {
    const Vec magnitude = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x);
    return _mm256_and_ps(x, _mm256_cmp_ps(magnitude, _mm256_set1_ps(3.0e38f), _CMP_LE_OQ));
  }
  static Ints to_ints(Vec x) { return _mm256_cvtps_epi32(x); }
  static void store(std::int32_t* at, Ints x) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(at), x);
  }

  // The weight of a sample in the low 16 bits, that of the next sample in the high 16 bits.
  using Weights = Ints;
  static Weights weights_of(Vec across) {
    const Ints next = to_ints(_mm256_mul_ps(across, splat(tiles::kOne)));
    const Ints both = _mm256_sub_epi32(_mm256_slli_epi32(next, 16), next);
    return _mm256_add_epi32(both, _mm256_set1_epi32(tiles::kOne));
  }

  class Neighbours {
   public:
    struct Reach {
      std::int32_t rows = 0;  // of upper neighbours of a group; 0: too far apart, so gathered
      std::int32_t rows_beyond = 0;

      Reach() = default;
      Reach(float x, float y) {
        constexpr float kRounding = 0.125f;  // positions in an image are exact to 2^-10
        const float across = (kGroup - 1) * std::abs(x) + kRounding;
        const float down = (kGroup - 1) * std::abs(y) + kRounding;
        if (across < kLoaded - 2 && down < kMaxRows - 1) {  // false for NaN
          rows = static_cast<std::int32_t>(down) + 2;
          rows_beyond = rows - 1;
        }
      }
    };

    Neighbours() = default;
    Neighbours(Vec column, Vec row, std::int32_t stride, Vec across, Reach reach)
        : weights_(weights_of(across)), stride_(stride), rows_(reach.rows) {
      const Vec left = least(column), top = least(row);
      store(first_, to_ints(fma(left, top, splat(static_cast<float>(stride)))));
      from_top_ = sub(row, top);
      const Ints from_left = to_ints(sub(column, left));
      order_ = rows_ > 0 ? bytes_of(from_left) : from_left;
    }

    template <int kCount>
    void rows_of(const std::uint16_t* const* copies, Vec* upper, Vec* lower) const {
      Ints above[kCount], below[kCount];
      if (rows_ > 0) {
        pick<kCount>(copies, above, below);
      } else {
        const Ints index = indices();
        for (int c = 0; c < kCount; ++c) {
          above[c] = gather(copies[c], index);
          below[c] = gather(copies[c] + stride_, index);
        }
      }
      for (int c = 0; c < kCount; ++c) {
        upper[c] = interpolated(above[c]);
        lower[c] = interpolated(below[c]);
      }
    }

   private:
    // In all lanes of a group the least of its lanes, which is the first or the last, because
    // positions lie on a line.
    static Vec least(Vec x) {
      return min(_mm256_permute_ps(x, 0b00000000), _mm256_permute_ps(x, 0b11111111));
    }

    // The bytes of the pairs at these samples of a group's vector.
    static Ints bytes_of(Ints samples) {
      const Ints lowest = _mm256_setr_epi32(0x00000000, 0x04040404, 0x08080808, 0x0C0C0C0C,
                                            0x00000000, 0x04040404, 0x08080808, 0x0C0C0C0C);
      const Ints first = _mm256_shuffle_epi8(_mm256_add_epi32(samples, samples), lowest);
      return _mm256_add_epi32(first, _mm256_set1_epi32(0x03020100));
    }

    static Ints samples(const std::uint16_t* copy, const std::ptrdiff_t* at) {
      const auto load = [&](int group) {
        return _mm_loadu_si128(reinterpret_cast<const __m128i*>(copy + at[group]));
      };
      return _mm256_inserti128_si256(_mm256_castsi128_si256(load(0)), load(1), 1);
    }

    template <int kCount>
    MIEN_LOADS_BEYOND void pick(const std::uint16_t* const* copies, Ints* above,
                                Ints* below) const {
      std::ptrdiff_t at[] = {first_[0], first_[kGroup]};
      Ints here[kCount];
      for (int c = 0; c < kCount; ++c) {
        above[c] = below[c] = _mm256_setzero_si256();
        here[c] = samples(copies[c], at);
      }
      const auto take = [&](int row) {
        const Vec elsewhere = _mm256_cmp_ps(from_top_, splat(static_cast<float>(row)), _CMP_NEQ_OQ);
        // Bytes with the highest bit select 0.
        const Ints order = _mm256_or_si256(order_, _mm256_castps_si256(elsewhere));
        at[0] += stride_, at[1] += stride_;
        for (int c = 0; c < kCount; ++c) {
          const Ints next = samples(copies[c], at);
          above[c] = _mm256_or_si256(above[c], _mm256_shuffle_epi8(here[c], order));
          below[c] = _mm256_or_si256(below[c], _mm256_shuffle_epi8(next, order));
          here[c] = next;
        }
      };
      take(0);
      take(1);
      for (int row = 2; row < rows_; ++row) {
        take(row);
      }
    }

    [[nodiscard]] Vec interpolated(Ints pairs) const {
      return _mm256_cvtepi32_ps(_mm256_madd_epi16(pairs, weights_));
    }
    [[nodiscard]] Ints indices() const {
      const Ints first = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(first_));
      const Ints down = _mm256_mullo_epi32(to_ints(from_top_), _mm256_set1_epi32(stride_));
      return _mm256_add_epi32(_mm256_add_epi32(first, down), order_);
    }
    static Ints gather(const std::uint16_t* base, Ints index) {
      // A masked gather with an explicit source and a mask of all lanes that is computed, because
      // otherwise the compiler uses any register as the source and each gather depends on it.
      const Ints all = _mm256_cmpgt_epi32(index, _mm256_set1_epi32(-1));
      return _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), reinterpret_cast<const int*>(base),
                                         index, all, 2);
    }

    Ints weights_;
    Ints order_;    // bytes of the pairs in a vector of samples; to gather: columns from the first
    Vec from_top_;  // rows from the first row of the group
    std::int32_t first_[kLanes];  // first row and column of the group, as an index
    std::int32_t stride_, rows_;
  };

  // The lanes of each output vector hold every third value of each colour.
  static void store_rgb(float* at, Vec r, Vec g, Vec b) {
    const auto third = [&](int first, Vec x, Vec y, Vec z) {
      const Vec xy = _mm256_blend_ps(x, y, 0b10010010);
      _mm256_storeu_ps(at + first, _mm256_blend_ps(xy, z, 0b00100100));
    };
    const auto permute = [](Vec x, Ints order) { return _mm256_permutevar8x32_ps(x, order); };
    const Ints red = _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5);
    const Ints green = _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2);
    const Ints blue = _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7);
    r = permute(r, red), g = permute(g, green), b = permute(b, blue);
    third(0, r, g, b);
    third(8, b, r, g);
    third(16, g, b, r);
  }

  static constexpr std::int32_t kSums = 16;
  using Sums = __m256i;

  static Sums load_sums(const std::uint16_t* at) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
  }
  static void store_sums(std::uint16_t* at, Sums x) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(at), x);
  }
  static Sums add_sums(Sums a, Sums b) { return _mm256_add_epi16(a, b); }

  static Sums bytes(const std::uint8_t* at) {
    return _mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(at)));
  }
  static Sums both_bytes(const std::uint8_t* at) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
  }
  static Sums byte_pairs(const std::uint8_t* at) {
    return _mm256_maddubs_epi16(both_bytes(at), _mm256_set1_epi8(1));
  }
  static Sums even_bytes(const std::uint8_t* at) {
    return _mm256_and_si256(both_bytes(at), _mm256_set1_epi16(0xFF));
  }

  static Sums halves(__m256i a, __m256i b) {
    return _mm256_permute4x64_epi64(_mm256_packus_epi32(a, b), 0b11011000);
  }
  static Sums pairs(Sums a, Sums b) {
    const __m256i ones = _mm256_set1_epi16(1);
    return halves(_mm256_madd_epi16(a, ones), _mm256_madd_epi16(b, ones));
  }
  static Sums evens(Sums a, Sums b) {
    const __m256i even = _mm256_set1_epi32(0xFFFF);
    return halves(_mm256_and_si256(a, even), _mm256_and_si256(b, even));
  }
};

}  // namespace

void warp(const WarpArgs& a) {
  tiles::Warp<Simd> tiles(a);
  tiles.run();
}

}  // namespace mien::kernels::avx2
