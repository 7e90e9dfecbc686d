// The wasm tier of activate.
#include "kernels/common/wasm_activation.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {

void activate(const ActivateArgs& a) {
  const Activator activator(a.activation, a.channels);
  for (std::int32_t channel = 0; channel < blocks_of(a.channels) * kBlock; channel += kLanes) {
    const Vec mask = lane_mask(channel, a.channels);
    const std::ptrdiff_t begin =
        std::ptrdiff_t{channel / kBlock} * a.pixels * kBlock + channel % kBlock;
    for (std::int32_t p = 0; p < a.pixels; ++p) {
      const std::ptrdiff_t at = begin + std::ptrdiff_t{p} * kBlock;
      store(a.y + at, only(mask, activator.clamped(load(a.x + at))));
    }
    activator.curve_channels(a.y + begin, a.pixels, channel);
  }
}

}  // namespace mien::kernels::wasm
