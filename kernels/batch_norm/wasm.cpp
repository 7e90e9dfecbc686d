#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

// Values of four channels; the parameters are not padded to whole blocks.
Vec load_channels(const float* values, std::int32_t first, std::int32_t channels, float otherwise) {
  float lanes[kLanes];
  for (std::int32_t i = 0; i < kLanes; ++i) {
    lanes[i] = first + i < channels ? values[first + i] : otherwise;
  }
  return load(lanes);
}

void four_channels(const BatchNormArgs& a, std::int32_t first) {
  const Vec mean = load_channels(a.mean, first, a.channels, 0.0f);
  const Vec variance = load_channels(a.variance, first, a.channels, 1.0f);
  const Vec gain = load_channels(a.gain, first, a.channels, 0.0f);
  const Vec offset = load_channels(a.offset, first, a.channels, 0.0f);
  const Vec deviation = wasm_f32x4_sqrt(wasm_f32x4_add(variance, splat(a.epsilon)));
  const Vec mask = lane_mask(first, a.channels);
  const std::ptrdiff_t begin = std::ptrdiff_t{first / kBlock} * a.pixels * kBlock + first % kBlock;
  const float* x = a.x + begin;
  float* y = a.y + begin;
  for (std::int32_t p = 0; p < a.pixels; ++p, x += kBlock, y += kBlock) {
    const Vec centred = wasm_f32x4_div(wasm_f32x4_sub(load(x), mean), deviation);
    store(y, only(mask, add_product(offset, centred, gain)));
  }
}

}  // namespace

void batch_norm(const BatchNormArgs& a) {
  for (std::int32_t first = 0; first < blocks_of(a.channels) * kBlock; first += kLanes) {
    four_channels(a, first);
  }
}

}  // namespace mien::kernels::wasm
