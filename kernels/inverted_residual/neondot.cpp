// The neondot tier of inverted_residual.
#include "kernels/families.h"
#include "kernels/inverted_residual/dot_strips.h"

namespace mien::kernels::neondot {
namespace {

// SDOT selects 4 of the 16 channels of a pixel.
struct Planes {
  static constexpr std::int32_t kChannels = kPanel;
  [[gnu::always_inline]] static void store(std::int8_t* y, std::ptrdiff_t /*plane_elems*/,
                                           int8x16_t pixel) {
    vst1q_s8(y, pixel);
  }
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) { run_dot_strips<Planes>(a); }

}  // namespace mien::kernels::neondot
