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

void inverted_residual(const InvertedResidualArgs& a) {
  if (DotStrips<Planes>::can_run(a)) {
    InvertedResidual<DotStrips<Planes>>(a).run();
  } else {
    neonfp16::inverted_residual(a);
  }
}

}  // namespace mien::kernels::neondot
