// The neoni8mm tier of fma_peak.
#include "kernels/families.h"
#include "kernels/fma_peak/neon_integer_peak.h"

namespace mien::kernels::neoni8mm {
namespace {

struct Vector : IntegerVector {
  static constexpr int kProducts = 32;

  static Sum multiply_add(Sum sum, Sum value, Sum weight) {
    return vmmlaq_s32(sum, vreinterpretq_s8_s32(value), vreinterpretq_s8_s32(weight));
  }
};

}  // namespace

void fma_peak(const FmaPeakArgs& a) { integer_peak<Vector>(a); }

}  // namespace mien::kernels::neoni8mm
