// The neoni8mm tier of inverted_residual.
#include "kernels/families.h"
#include "kernels/inverted_residual/dot_strips.h"

namespace mien::kernels::neoni8mm {
namespace {

// SMMLA takes 8 channels of two pixels, which are adjacent in planes of 8 channels.
struct Planes {
  static constexpr std::int32_t kChannels = kBlock;
  [[gnu::always_inline]] static void store(std::int8_t* y, std::ptrdiff_t plane_elems,
                                           int8x16_t pixel) {
    vst1_s8(y, vget_low_s8(pixel));
    vst1_s8(y + plane_elems, vget_high_s8(pixel));
  }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) { run_dot_strips<Planes>(a); }

}  // namespace mien::kernels::neoni8mm
