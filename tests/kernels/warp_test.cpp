#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::kernels {
namespace {

// Chroma of an image of one pixel has as many samples as luma, but half their distance.
TEST(Warp, OnePixelHasOneColourWhereverItIsLookedAt) {
  constexpr std::int32_t kHeight = 30, kWidth = 90;
  const std::uint8_t luma = 150, u = 90, v = 170;
  for (const Entry& entry : all_kernels()) {
    if (entry.family != WarpArgs::kFamily || (detect_cpu() & bit(entry.tier)) == 0) {
      continue;
    }
    std::vector<float> picture(std::size_t{3} * kHeight * kWidth);
    std::vector<std::uint16_t> samples(kWarpSampleElems);
    WarpArgs args{};
    args.format = PixelFormat::kYuv420;
    args.plane[0] = {&luma, 1, 1};
    args.plane[1] = {&u, 1, 1};
    args.plane[2] = {&v, 1, 1};
    args.full_range = true;
    args.yuv_matrix = kBt601;
    args.image_width = args.image_height = 1;
    const float matrix[6] = {0.001f, 0.0f, 4.2f, 0.0f, 0.001f, 4.2f};  // beyond the border
    std::copy_n(matrix, 6, args.matrix);
    args.box = args.chroma_box = 1;
    args.y = picture.data();
    args.width = kWidth;
    args.height = kHeight;
    args.scale = 1.0f;
    args.samples = samples.data();
    find<WarpArgs>(bit(entry.tier))(args);
    for (std::size_t i = 0; i < picture.size(); i += 3) {
      ASSERT_NEAR(picture[i], 150 + 1.402 * (170 - 128), 0.05)
          << name(entry.tier) << ", number " << i;
      ASSERT_NEAR(picture[i + 2], 150 + 1.772 * (90 - 128), 0.05)
          << name(entry.tier) << ", number " << i;
    }
  }
}

}  // namespace
}  // namespace mien::kernels
