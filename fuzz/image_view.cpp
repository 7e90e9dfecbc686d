// An image of any format, size, strides and rotation is rejected, or crops at any place can be
// sampled from it.
#include "tracker/image/image_view.h"

#include <cmath>
#include <vector>

#include "fuzz/target.h"
#include "fuzz/views.h"
#include "tracker/image/sampler.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mien;
  fuzz::Bytes choices(data, size);
  std::vector<std::byte> memory[3];
  const mien_image image = fuzz::take_image(choices, memory);
  tracker::ImageView view;
  if (tracker::view_image(&image, 1.0f, view) != MIEN_OK) {
    return 0;
  }
  alignas(engine::Arena::kAlignment) static std::byte
      samples[kernels::kWarpSampleElems * sizeof(std::uint16_t)];
  engine::Arena arena(samples, {.shared_bytes = sizeof samples});
  tracker::Sampler sampler;
  fuzz::require(sampler.init(choices.coin() ? MIEN_CPU_REF : MIEN_CPU_ALL, arena));
  for (int i = 0; i < 2; ++i) {
    const auto coordinate = [&] {
      return static_cast<float>(choices.take<std::int16_t>()) /
             choices.one_of({1.0f, 64.0f, 300.0f});
    };
    const tracker::Crop crop = {{coordinate(), coordinate()},
                                std::abs(coordinate()) + 1e-3f,
                                static_cast<float>(choices.between(0, 628)) / 100.0f};
    const tracker::Raster raster = {choices.between(1, 9), choices.between(1, 40), 1.0f};
    std::vector<float> pixels(static_cast<std::size_t>(3 * raster.rows * raster.columns));
    sampler.warp(view, crop, raster, pixels);
    for (const float value : pixels) {
      fuzz::require(value >= -1.0001f && value <= 1.0001f);
    }
  }
  return 0;
}
