// The same scene gives the same result in every format, layout, rotation and region.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

constexpr int kWidth = 151;  // odd, to test chroma subsampling
constexpr int kHeight = 113;

Picture scene(int frame) {
  Picture picture(kWidth, kHeight);
  picture.disc(70.0f + static_cast<float>(frame), 55.0f, 44.0f);
  return picture;
}

Result after_frames(const Layout& layout, bool grey = false) {
  BlobTracker tracker;
  Result result;
  for (int frame = 0; frame < 7; ++frame) {
    Picture picture = scene(frame);
    if (grey) {
      picture.grey();
    }
    result = tracker.push(picture, layout);
    EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
  }
  return result;
}

void expect_identical(const Result& a, const Result& b) {
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(mien_result)), 0);
}

void expect_close(const Result& a, const Result& b, float pixels, float tolerance) {
  EXPECT_NEAR(a.face_probability, b.face_probability, tolerance);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(a.box[i], b.box[i], pixels);
    EXPECT_NEAR(a.rotation[i], b.rotation[i], tolerance);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(a.translation[i], b.translation[i], tolerance);
  }
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    EXPECT_NEAR(a.controls[i], b.controls[i], tolerance) << mien_control_name(i);
  }
  for (int i = 0; i < MIEN_LANDMARK_COUNT; ++i) {
    EXPECT_NEAR(a.landmarks[i][0], b.landmarks[i][0], pixels) << i;
    EXPECT_NEAR(a.landmarks[i][1], b.landmarks[i][1], pixels) << i;
  }
}

TEST(Equivariance, InterleavedFormatsGiveTheSameResult) {
  const Result rgb = after_frames({});
  for (mien_image_format format : {MIEN_IMAGE_BGR, MIEN_IMAGE_RGBA, MIEN_IMAGE_BGRA}) {
    expect_close(after_frames({.format = format}), rgb, 1e-3f, 1e-4f);
  }
}

TEST(Equivariance, YuvMatchesRgbUpToChromaDetail) {
  const Result rgb = after_frames({});
  for (mien_image_format format : {MIEN_IMAGE_NV12, MIEN_IMAGE_NV21, MIEN_IMAGE_I420}) {
    for (bool full_range : {true, false}) {
      for (mien_yuv_matrix matrix : {MIEN_YUV_BT601, MIEN_YUV_BT709}) {
        SCOPED_TRACE(testing::Message()
                     << format << (full_range ? " full" : " video") << ", matrix " << matrix);
        const Layout layout = {.format = format, .full_range = full_range, .yuv_matrix = matrix};
        expect_close(after_frames(layout), rgb, 0.5f, 0.03f);
      }
    }
  }
}

TEST(Equivariance, LayoutsOfTheSameYuvAgreeExactly) {
  const Result nv12 = after_frames({.format = MIEN_IMAGE_NV12});
  expect_close(after_frames({.format = MIEN_IMAGE_NV21}), nv12, 1e-3f, 1e-4f);
  for (int pixel_stride : {1, 2, 5}) {
    expect_close(after_frames({.format = MIEN_IMAGE_I420, .chroma_pixel_stride = pixel_stride}),
                 nv12, 1e-3f, 1e-4f);
  }
}

TEST(Equivariance, GreyGivesTheSameResultInEveryFormat) {
  const Result rgb = after_frames({}, true);
  for (mien_image_format format : {MIEN_IMAGE_GRAY8, MIEN_IMAGE_NV12, MIEN_IMAGE_I420}) {
    for (bool full_range : {true, false}) {
      SCOPED_TRACE(testing::Message() << format << (full_range ? " full" : " video"));
      expect_close(after_frames({.format = format, .full_range = full_range}, true), rgb, 0.1f,
                   0.01f);
    }
  }
}

TEST(Equivariance, ColourAffectsControls) {
  const Result colour = after_frames({});
  const Result grey = after_frames({}, true);
  float difference = 0.0f;
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    difference = std::max(difference, std::abs(colour.controls[i] - grey.controls[i]));
  }
  EXPECT_GT(difference, 1e-4f) << "the tests above must be able to detect a wrong channel order";
}

TEST(Equivariance, StridesDoNotMatter) {
  for (mien_image_format format :
       {MIEN_IMAGE_GRAY8, MIEN_IMAGE_RGB, MIEN_IMAGE_BGRA, MIEN_IMAGE_NV12, MIEN_IMAGE_I420}) {
    SCOPED_TRACE(format);
    const Result tight = after_frames({.format = format});
    expect_identical(after_frames({.format = format, .row_padding_bytes = 13}), tight);
    expect_identical(after_frames({.format = format, .bottom_up = true}), tight);
    expect_identical(after_frames({.format = format, .row_padding_bytes = 7, .bottom_up = true}),
                     tight);
  }
}

TEST(Equivariance, RotatedBuffersMatchUprightOnes) {
  for (mien_image_format format : {MIEN_IMAGE_RGB, MIEN_IMAGE_GRAY8}) {
    const Result upright = after_frames({.format = format});
    for (int rotation : {90, 180, 270}) {
      SCOPED_TRACE(rotation);
      expect_close(after_frames({.format = format, .rotation = rotation}), upright, 0.01f, 1e-3f);
    }
  }
}

// Converts the region {x, y, width, height} of the upright scene to the buffer.
void set_region(mien_image& image, const Layout& layout, int width, int height,
                const int (&scene)[4]) {
  const bool sideways = layout.rotation % 180 != 0;
  const int x = layout.mirrored ? width - scene[0] - scene[2] : scene[0];
  const int right = width - x - scene[2], bottom = height - scene[1] - scene[3];
  const int from_left[] = {x, scene[1], right, bottom};
  const int from_top[] = {scene[1], right, bottom, x};
  const int turns = layout.rotation / 90;
  image.region[0] = from_left[turns];
  image.region[1] = from_top[turns];
  image.region[2] = scene[sideways ? 3 : 2];
  image.region[3] = scene[sideways ? 2 : 3];
}

TEST(Equivariance, RegionsMatchCroppedImages) {
  constexpr int kWhole[2] = {300, 220};
  constexpr int kRegion[4] = {60, 42, 152, 112};
  // The image of one camera, starting at pixel (x, y).
  const auto image_of = [](const Buffer& buffer, int x, int y) {
    mien_image image = buffer.image();
    image.focal_length_px = 250.0f;
    image.principal_x = static_cast<float>(130 - x);
    image.principal_y = static_cast<float>(100 - y);
    return image;
  };
  for (mien_image_format format :
       {MIEN_IMAGE_RGB, MIEN_IMAGE_BGRA, MIEN_IMAGE_NV12, MIEN_IMAGE_I420}) {
    for (int rotation : {0, 90, 180, 270}) {
      SCOPED_TRACE(testing::Message() << format << ", " << rotation);
      const Layout layout = {.format = format, .rotation = rotation, .row_padding_bytes = 5};
      BlobTracker whole, part;
      Result whole_result, part_result;
      for (int frame = 0; frame < 7; ++frame) {
        Picture picture(kWhole[0], kWhole[1]);
        picture.disc(250.0f, 150.0f, 75.0f);  // outside, and larger
        picture.disc(130.0f + static_cast<float>(frame), 97.0f, 44.0f);
        const Buffer buffer(picture, layout);
        mien_image image = image_of(buffer, 0, 0);
        set_region(image, layout, kWhole[0], kWhole[1], kRegion);
        whole_result = whole.push(image);
        const Buffer cut(picture.part(kRegion[0], kRegion[1], kRegion[2], kRegion[3]), layout);
        part_result = part.push(image_of(cut, kRegion[0], kRegion[1]));
      }
      ASSERT_EQ(whole_result.status, MIEN_FACE_TRACKING);
      part_result.box[0] += kRegion[0];
      part_result.box[1] += kRegion[1];
      for (auto& point : part_result.landmarks) {
        point[0] += kRegion[0];
        point[1] += kRegion[1];
      }
      expect_close(whole_result, part_result, 0.01f, 1e-3f);
    }
  }
}

// A mirrored region of the scene shows the same as the unmirrored region.
TEST(Equivariance, RegionsOfMirroredImagesMatchPlainOnes) {
  constexpr int kRegion[4] = {40, 12, 90, 90};
  const auto result_of = [&](const Layout& layout) {
    BlobTracker tracker;
    Result result;
    for (int frame = 0; frame < 7; ++frame) {
      const Buffer buffer(scene(frame), layout);
      mien_image image = buffer.image();
      set_region(image, layout, kWidth, kHeight, kRegion);
      result = tracker.push(image);
    }
    EXPECT_EQ(result.status, MIEN_FACE_TRACKING);
    return result;
  };
  const Result plain = result_of({});
  for (int rotation : {0, 90, 180, 270}) {
    SCOPED_TRACE(rotation);
    Result mirrored = result_of({.rotation = rotation, .mirrored = true});
    mirrored.box[0] = kWidth - (mirrored.box[0] + mirrored.box[2]);
    for (auto& point : mirrored.landmarks) {
      point[0] = kWidth - point[0];
    }
    expect_close(mirrored, plain, 0.01f, 1e-3f);
  }
}

// The caller moves the region with the face.
TEST(Equivariance, RegionsMayMoveDuringTracking) {
  BlobTracker tracker;
  const Buffer buffer(disc_picture(160.0f, 120.0f, 60.0f), {});
  Result result;
  for (int frame = 0; frame < 20; ++frame) {
    mien_image image = buffer.image();
    const int region[4] = {60 + frame, 50 + frame / 2, 170, 150};
    std::copy(std::begin(region), std::end(region), image.region);
    result = tracker.push(image);
  }
  EXPECT_TRUE(result.has_face());
  EXPECT_EQ(result.face_id, 1u);
  EXPECT_EQ(result.proposal_runs, 1u) << "the face was never lost";
  EXPECT_NEAR(result.box[0] + result.box[2] / 2, 160.0f, 12.0f);
}

// The memory contains only the region, which the address sanitizer checks; the image claims a
// border around it.
TEST(Equivariance, PixelsOutsideTheRegionAreNotRead) {
  for (mien_image_format format : {MIEN_IMAGE_RGBA, MIEN_IMAGE_NV21, MIEN_IMAGE_I420}) {
    const Layout layout = {.format = format, .row_padding_bytes = 40};
    const Buffer buffer(disc_picture(50.0f, 50.0f, 50.0f, 100, 100), layout);
    mien_image image = buffer.image();
    const int pixel_bytes = format == MIEN_IMAGE_RGBA ? 4 : 1;
    const int chroma_bytes = format == MIEN_IMAGE_I420 ? 1 : 2;
    const auto begin_earlier = [&image](int plane, int rows, int bytes) {
      const auto address = reinterpret_cast<std::uintptr_t>(image.planes[plane]);
      const auto before = static_cast<std::uintptr_t>(rows * image.row_stride_bytes[plane] + bytes);
      image.planes[plane] = reinterpret_cast<const void*>(address - before);
    };
    begin_earlier(0, 6, 8 * pixel_bytes);
    begin_earlier(1, 3, 4 * chroma_bytes);
    begin_earlier(2, 3, 4 * chroma_bytes);
    image.width = 108;
    image.height = 130;
    const int region[4] = {8, 6, 100, 100};
    std::copy(std::begin(region), std::end(region), image.region);
    BlobTracker tracker;
    EXPECT_TRUE(tracker.push(image).has_face()) << format;
  }
}

TEST(Equivariance, MirroredBuffersGiveTheSameAnimation) {
  const Result plain = after_frames({});
  for (int rotation : {0, 90, 180, 270}) {
    SCOPED_TRACE(rotation);
    Result mirrored = after_frames({.rotation = rotation, .mirrored = true});
    mirrored.box[0] = kWidth - (mirrored.box[0] + mirrored.box[2]);
    for (auto& point : mirrored.landmarks) {
      point[0] = kWidth - point[0];
    }
    expect_close(mirrored, plain, 0.01f, 1e-3f);
  }
}

// A longer focal length moves the head away along the same ray.
TEST(Equivariance, FocalLengthScalesOnlyDistance) {
  const Buffer buffer(scene(0), {});
  mien_image image = buffer.image();
  image.focal_length_px = 200.0f;
  BlobTracker near;
  const Result a = near.push(image);
  image.focal_length_px = 400.0f;
  BlobTracker far;
  const Result b = far.push(image);
  EXPECT_NEAR(b.translation[2] / a.translation[2], 2.0f, 1e-4f);
  EXPECT_NEAR(b.translation[0], a.translation[0], 1e-5f);
  EXPECT_NEAR(b.translation[1], a.translation[1], 1e-5f);
}

}  // namespace
}  // namespace mien::tests
