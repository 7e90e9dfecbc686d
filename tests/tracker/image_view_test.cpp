// Tests of the validation and the coordinates of images.
#include "tracker/image/image_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <vector>

namespace mien::tracker {
namespace {

constexpr float kFov = 1.0f;
const unsigned char kPixels[64] = {};

mien_image image_of(mien_image_format format, int width, int height) {
  mien_image image;
  mien_image_default(&image);
  image.format = format;
  image.width = width;
  image.height = height;
  for (int i = 0; i < 3; ++i) {
    image.planes[i] = kPixels;
    image.row_stride_bytes[i] = 4 * width + 8;
  }
  return image;
}

mien_status status_of(const mien_image& image) {
  ImageView view;
  return view_image(&image, kFov, view);
}

ImageView view_of(const mien_image& image) {
  ImageView view;
  EXPECT_EQ(view_image(&image, kFov, view), MIEN_OK);
  return view;
}

void expect_point(Point p, float x, float y) {
  EXPECT_FLOAT_EQ(p.x, x);
  EXPECT_FLOAT_EQ(p.y, y);
}

// Tracks the top left pixel of a 4 x 2 buffer through every rotation.
TEST(ImageView, RotationIsClockwise) {
  mien_image image = image_of(MIEN_IMAGE_GRAY8, 4, 2);
  const struct {
    int rotation;
    float width, height, x, y;  // upright size and position of the buffer's first pixel
  } cases[] = {{0, 4, 2, 0.5f, 0.5f},
               {90, 2, 4, 1.5f, 0.5f},
               {180, 4, 2, 3.5f, 1.5f},
               {270, 2, 4, 0.5f, 3.5f}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.rotation);
    image.rotation = c.rotation;
    image.mirrored = 0;
    ImageView view = view_of(image);
    EXPECT_EQ(view.width, c.width);
    EXPECT_EQ(view.height, c.height);
    expect_point(view.to_buffer({c.x, c.y}), 0.5f, 0.5f);
    image.mirrored = 1;
    view = view_of(image);
    expect_point(view.to_buffer({c.width - c.x, c.y}), 0.5f, 0.5f);
    expect_point(to_upright(view, {c.width - c.x, c.y}), c.x, c.y);
  }
}

// Two columns of the buffer are three of the scene; the height does not change.
TEST(ImageView, StretchesNonSquarePixels) {
  mien_image image = image_of(MIEN_IMAGE_GRAY8, 40, 30);
  image.pixel_aspect = 1.5f;
  image.region[0] = 10;
  image.region[1] = 6;
  image.region[2] = 20;
  image.region[3] = 12;
  ImageView view = view_of(image);
  EXPECT_FLOAT_EQ(view.width, 60.0f);
  EXPECT_FLOAT_EQ(view.height, 30.0f);
  expect_point(view.to_buffer({30.0f, 12.0f}), 10.0f, 6.0f);  // in the cropped buffer
  expect_point(view.region.corner, 15.0f, 6.0f);
  EXPECT_FLOAT_EQ(view.region.width, 30.0f);
  EXPECT_FLOAT_EQ(view.region.height, 12.0f);
  EXPECT_FLOAT_EQ(view.camera.focal_px, 30.0f / std::tan(kFov / 2));
  EXPECT_EQ(view.buffer_pixels_per_pixel, 1.0f);
  image.mirrored = 1;
  expect_point(view_of(image).to_buffer({30.0f, 12.0f}), 10.0f, 6.0f);
  expect_point(view_of(image).region.corner, 15.0f, 6.0f);
  image.mirrored = 0;
  image.rotation = 90;  // rotated pixels are 1 / 1.5 as wide as high
  view = view_of(image);
  EXPECT_FLOAT_EQ(view.width, 20.0f);
  EXPECT_FLOAT_EQ(view.height, 40.0f);
  EXPECT_FLOAT_EQ(view.region.corner.x, 8.0f);
  EXPECT_FLOAT_EQ(view.region.width, 8.0f);
  EXPECT_FLOAT_EQ(view.region.height, 20.0f);
  EXPECT_FLOAT_EQ(view.buffer_pixels_per_pixel, 1.5f);
}

TEST(ImageView, ChecksTheRangeOfPixelAspect) {
  mien_image image = image_of(MIEN_IMAGE_GRAY8, 4, 2);
  for (float good : {0.0f, 0.1f, 1.0f, 10.0f}) {
    image.pixel_aspect = good;
    EXPECT_EQ(status_of(image), MIEN_OK) << good;
  }
  for (float bad : {-1.0f, 0.01f, 10.5f, std::numeric_limits<float>::quiet_NaN(),
                    std::numeric_limits<float>::infinity()}) {
    image.pixel_aspect = bad;
    EXPECT_EQ(status_of(image), MIEN_ERROR_IMAGE_SIZE) << bad;
  }
}

TEST(ImageView, ChecksThatTheRegionLiesInTheImage) {
  const auto status_with = [](mien_image_format format, std::initializer_list<int> region) {
    mien_image image = image_of(format, 4, 2);
    std::copy(region.begin(), region.end(), image.region);
    return status_of(image);
  };
  for (const auto& region : {std::initializer_list<int>{0, 0, 0, 0}, {0, 0, 4, 2}, {3, 1, 1, 1}}) {
    EXPECT_EQ(status_with(MIEN_IMAGE_GRAY8, region), MIEN_OK);
  }
  constexpr int kMax = std::numeric_limits<int>::max();
  constexpr int kMin = std::numeric_limits<int>::min();
  for (const auto& region : {std::initializer_list<int>{1, 0, 4, 2},
                             {0, 1, 4, 2},
                             {0, 0, 0, 2},
                             {0, 0, 4, 0},
                             {-1, 0, 2, 2},
                             {0, -1, 2, 2},
                             {1, 0, 0, 0},
                             {kMax, 0, kMax, 1},
                             {0, kMin, 1, kMin}}) {
    EXPECT_EQ(status_with(MIEN_IMAGE_GRAY8, region), MIEN_ERROR_IMAGE_REGION);
  }
  EXPECT_EQ(status_with(MIEN_IMAGE_NV12, {2, 0, 1, 1}), MIEN_OK);
  EXPECT_EQ(status_with(MIEN_IMAGE_NV12, {1, 0, 2, 2}), MIEN_ERROR_IMAGE_REGION);
  EXPECT_EQ(status_with(MIEN_IMAGE_I420, {0, 1, 2, 1}), MIEN_ERROR_IMAGE_REGION);
}

TEST(ImageView, RejectsUnknownYuvMatrices) {
  mien_image image = image_of(MIEN_IMAGE_NV12, 4, 2);
  image.yuv_matrix = MIEN_YUV_BT709;
  EXPECT_EQ(status_of(image), MIEN_OK);
  image.yuv_matrix = 2;
  EXPECT_EQ(status_of(image), MIEN_ERROR_IMAGE_FORMAT);
}

TEST(ImageView, CameraComesFromFieldOfViewOrCaller) {
  mien_image image = image_of(MIEN_IMAGE_GRAY8, 400, 200);
  image.rotation = 90;
  EXPECT_FLOAT_EQ(view_of(image).camera.focal_px, 100.0f / std::tan(kFov / 2));
  expect_point(view_of(image).camera.principal, 100.0f, 200.0f);
  image.focal_length_px = 345.0f;
  image.principal_x = 90.0f;
  image.principal_y = 210.0f;
  EXPECT_EQ(view_of(image).camera.focal_px, 345.0f);
  expect_point(view_of(image).camera.principal, 90.0f, 210.0f);
  image.mirrored = 1;
  expect_point(view_of(image).camera.principal, 110.0f, 210.0f);
}

TEST(ImageView, RejectsInvalidImages) {
  ImageView view;
  EXPECT_EQ(view_image(nullptr, kFov, view), MIEN_ERROR_NULL_ARGUMENT);
  const auto status_after = [](auto&& change) {
    mien_image image = image_of(MIEN_IMAGE_I420, 5, 3);
    EXPECT_EQ(status_of(image), MIEN_OK);
    change(image);
    return status_of(image);
  };
  EXPECT_EQ(status_after([](mien_image& i) { i.format = 8; }), MIEN_ERROR_IMAGE_FORMAT);
  EXPECT_EQ(status_after([](mien_image& i) { i.format = -1; }), MIEN_ERROR_IMAGE_FORMAT);
  for (int side : {0, -1, MIEN_MAX_IMAGE_SIDE + 1, std::numeric_limits<int>::max(),
                   std::numeric_limits<int>::min()}) {
    EXPECT_EQ(status_after([&](mien_image& i) { i.width = side; }), MIEN_ERROR_IMAGE_SIZE) << side;
    EXPECT_EQ(status_after([&](mien_image& i) { i.height = side; }), MIEN_ERROR_IMAGE_SIZE) << side;
  }
  for (int rotation : {1, -90, 360, 91}) {
    EXPECT_EQ(status_after([&](mien_image& i) { i.rotation = rotation; }),
              MIEN_ERROR_IMAGE_ROTATION);
  }
  for (int plane = 0; plane < 3; ++plane) {
    EXPECT_EQ(status_after([&](mien_image& i) { i.planes[plane] = nullptr; }),
              MIEN_ERROR_IMAGE_PLANE);
    EXPECT_EQ(status_after([&](mien_image& i) { i.row_stride_bytes[plane] = plane == 0 ? 4 : 2; }),
              MIEN_ERROR_IMAGE_STRIDE);
    EXPECT_EQ(status_after([&](mien_image& i) { i.row_stride_bytes[plane] = plane == 0 ? 5 : -3; }),
              MIEN_OK);
  }
  EXPECT_EQ(status_after([](mien_image& i) { i.chroma_pixel_stride_bytes = -1; }),
            MIEN_ERROR_IMAGE_STRIDE);
  for (float bad :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(status_after([&](mien_image& i) { i.focal_length_px = bad; }),
              MIEN_ERROR_IMAGE_CAMERA);
    EXPECT_EQ(status_after([&](mien_image& i) { i.principal_y = bad; }), MIEN_ERROR_IMAGE_CAMERA);
  }
}

TEST(ImageView, IgnoresUnusedPlanes) {
  mien_image image = image_of(MIEN_IMAGE_NV12, 5, 3);
  image.planes[2] = nullptr;
  image.row_stride_bytes[2] = 0;
  EXPECT_EQ(status_of(image), MIEN_OK);
  image.row_stride_bytes[1] = 5;  // 3 chroma samples of 2 bytes
  EXPECT_EQ(status_of(image), MIEN_ERROR_IMAGE_STRIDE);
}

TEST(ImageView, AcceptsShorterAndLongerStructs) {
  mien_image image = image_of(MIEN_IMAGE_GRAY8, 8, 4);
  image.rotation = 77;  // beyond struct_size
  image.struct_size = offsetof(mien_image, chroma_pixel_stride_bytes);
  EXPECT_EQ(view_of(image).image.rotation, 0);
  image.struct_size -= 1;
  EXPECT_EQ(status_of(image), MIEN_ERROR_STRUCT_SIZE);
  struct {
    mien_image image;
    unsigned char future[100];
  } longer = {image_of(MIEN_IMAGE_GRAY8, 8, 4), {1}};
  longer.image.struct_size = sizeof longer;
  EXPECT_EQ(status_of(longer.image), MIEN_OK);
}

TEST(ImageGeometry, DependsOnSizeRotationAndMirroringOnly) {
  const mien_image image = image_of(MIEN_IMAGE_GRAY8, 8, 4);
  const ImageGeometry before = view_of(image);
  const auto changed = [&](auto&& change) {
    mien_image other = image;
    change(other);
    return !(before == view_of(other));
  };
  EXPECT_FALSE(changed([](mien_image& i) { i.format = MIEN_IMAGE_RGB; }));
  EXPECT_TRUE(changed([](mien_image& i) { i.width = 9; }));
  EXPECT_TRUE(changed([](mien_image& i) { i.mirrored = 1; }));
  EXPECT_TRUE(changed([](mien_image& i) { i.rotation = 180; }));
}

}  // namespace
}  // namespace mien::tracker
