// Tests of the warp kernel: the colour of a pixel does not depend on the transform that samples it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "tests/kernels/warp_output.h"

namespace mien::kernels {
namespace {

// Chroma of an image of one pixel has as many samples as luma, but half their distance.
TEST(Warp, OnePixelHasOneColourWhereverItIsLookedAt) {
  const std::uint8_t luma = 150, u = 90, v = 170;
  for_each_tier([&](Tier tier) {
    Output out(PixelFormat::kYuv420);
    out.args.plane[0] = {&luma, 1, 1};
    out.args.plane[1] = {&u, 1, 1};
    out.args.plane[2] = {&v, 1, 1};
    out.args.image_width = out.args.image_height = 1;
    const float matrix[6] = {0.001f, 0.0f, 4.2f, 0.0f, 0.001f, 4.2f};  // beyond the border
    std::copy_n(matrix, 6, out.args.matrix);
    find<WarpArgs>(bit(tier))(out.args);
    for (std::size_t i = 0; i < out.picture.size(); i += 3) {
      ASSERT_NEAR(out.picture[i], 150 + 1.402 * (170 - 128), 0.05) << name(tier) << ", " << i;
      ASSERT_NEAR(out.picture[i + 2], 150 + 1.772 * (90 - 128), 0.05) << name(tier) << ", " << i;
    }
  });
}

}  // namespace
}  // namespace mien::kernels
