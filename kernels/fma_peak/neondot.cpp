// The neondot tier of fma_peak.
#include "kernels/families.h"
#include "kernels/fma_peak/neon_integer_peak.h"

namespace mien::kernels::neondot {
namespace {

struct Vector : IntegerVector {
  static constexpr int kProducts = 16;

  static Sum multiply_add(Sum sum, Sum value, Sum weight) {
    return vdotq_s32(sum, vreinterpretq_s8_s32(value), vreinterpretq_s8_s32(weight));
  }
};

}  // namespace

void fma_peak(const FmaPeakArgs& a) { integer_peak<Vector>(a); }

}  // namespace mien::kernels::neondot
