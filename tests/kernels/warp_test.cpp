// The image warp of every tier against the reference: formats, odd sizes, strides, far and
// meaningless transforms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernels/families.h"
#include "kernels/registry.h"
#include "tests/kernels/guarded.h"
#include "tests/kernels/random_values.h"

namespace mien::tests {
namespace {

using namespace kernels;  // NOLINT: the test is about nothing else

constexpr int kOut = 13;

// A plane whose last row ends at the guard page: no padding may be read.
struct TestPlane {
  TestPlane(RandomValues& random, int width, int height, int pixel_bytes, int used_bytes, Edge edge)
      : row(width * pixel_bytes + random.between(0, 5)),
        bytes(static_cast<std::size_t>(row * (height - 1) + (width - 1) * pixel_bytes + used_bytes),
              edge),
        pixel(pixel_bytes),
        rows(height) {
    for (int i = 0; i < row * (height - 1) + (width - 1) * pixel_bytes + used_bytes; ++i) {
      bytes.data()[i] = static_cast<unsigned char>(random.between(0, 255));
    }
  }
  Plane top_down() const { return {bytes.data(), row, pixel}; }
  Plane bottom_up() const {
    return {bytes.data() + static_cast<std::ptrdiff_t>(row) * (rows - 1), -row, pixel};
  }

  int row;
  GuardedBytes bytes;
  int pixel, rows;
};

int bytes_per_pixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb:
    case PixelFormat::kBgr:
      return 3;
    case PixelFormat::kRgba:
    case PixelFormat::kBgra:
      return 4;
    default:
      return 1;
  }
}

class WarpTest : public testing::TestWithParam<int> {};

void compare_tiers(WarpArgs args, double tolerance) {
  std::vector<float> want(kOut * kOut * 3);
  args.y = want.data();
  find<WarpArgs>(bit(Tier::kRef))(args);
  for (const float one : want) {
    ASSERT_TRUE(std::isfinite(one));
  }
  for (std::uint32_t tier = 1; tier < kTierCount; ++tier) {
    if ((detect_cpu() & (1u << tier)) == 0) {
      continue;
    }
    Guarded<float> got(std::vector<float>(want.size()), Edge::kEnd);
    args.y = got.data();
    find<WarpArgs>(1u << tier)(args);
    for (std::size_t i = 0; i < want.size(); ++i) {
      ASSERT_NEAR(got.span()[i], want[i], tolerance) << "sample " << i;
    }
  }
}

TEST_P(WarpTest, AgreesWithTheReference) {
  const auto format = static_cast<PixelFormat>(GetParam());
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomValues random(seed);
    const int width = random.between(1, 40), height = random.between(1, 40);
    const Edge edge = seed % 2 == 0 ? Edge::kEnd : Edge::kStart;
    const int pixel = bytes_per_pixel(format);
    const TestPlane first(random, width, height, pixel, std::min(pixel, 3), edge);
    const TestPlane u(random, (width + 1) / 2, (height + 1) / 2, 2, 1, edge);
    const TestPlane v(random, (width + 1) / 2, (height + 1) / 2, 1, 1, edge);
    const bool flipped = random.between(0, 1) == 1;
    WarpArgs args{};
    args.format = format;
    args.plane[0] = flipped ? first.bottom_up() : first.top_down();
    args.plane[1] = u.top_down();
    args.plane[2] = flipped ? v.bottom_up() : v.top_down();
    args.full_range = random.between(0, 1) == 1;
    args.image_width = width;
    args.image_height = height;
    for (float& one : args.matrix) {
      one = static_cast<float>(random.between(-300, 300)) * 0.01f;
    }
    args.matrix[2] = static_cast<float>(random.between(-50, 80));
    args.matrix[5] = static_cast<float>(random.between(-50, 80));
    args.taps = random.between(1, 3);
    args.width = args.height = kOut;
    args.scale = 1.0f / 127.5f;
    args.offset = -1.0f;
    // Coordinates to 1e-5 pixels, neighbours up to 255 apart.
    compare_tiers(args, 255.0 * 4e-5 / 127.5 * 4.0);
  }
}

TEST_P(WarpTest, MeaninglessTransformsAreHarmless) {
  const auto format = static_cast<PixelFormat>(GetParam());
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {1e30f, -1e30f, infinity, -infinity, nan, 3e9f}) {
    RandomValues random(1);
    const TestPlane first(random, 7, 5, bytes_per_pixel(format),
                          std::min(bytes_per_pixel(format), 3), Edge::kEnd);
    const TestPlane chroma(random, 4, 3, 1, 1, Edge::kEnd);
    WarpArgs args{};
    args.format = format;
    args.plane[0] = first.top_down();
    args.plane[1] = args.plane[2] = chroma.top_down();
    args.image_width = 7;
    args.image_height = 5;
    args.taps = 1;
    args.width = args.height = kOut;
    args.scale = 1.0f;
    for (int i = 0; i < 6; ++i) {
      std::fill(args.matrix, args.matrix + 6, 0.5f);
      args.matrix[i] = value;
      std::vector<float> y(kOut * kOut * 3);
      args.y = y.data();
      for (std::uint32_t tier = 0; tier < kTierCount; ++tier) {
        if ((detect_cpu() & (1u << tier)) != 0) {
          find<WarpArgs>(1u << tier)(args);
          for (const float one : y) {
            ASSERT_TRUE(one >= 0.0f && one <= 255.0f);
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, WarpTest, testing::Range(0, 6));

}  // namespace
}  // namespace mien::tests
