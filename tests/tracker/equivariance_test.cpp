// The same scene, delivered in every way a camera may deliver it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

constexpr int kWidth = 151;  // odd on purpose
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

void expect_same(const Result& a, const Result& b) {
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(mien_result)), 0);
}

void expect_close(const Result& a, const Result& b, float pixels, float share) {
  EXPECT_NEAR(a.face_probability, b.face_probability, share);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(a.box[i], b.box[i], pixels);
    EXPECT_NEAR(a.rotation[i], b.rotation[i], share);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(a.translation[i], b.translation[i], share);
  }
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    EXPECT_NEAR(a.controls[i], b.controls[i], share) << mien_control_name(i);
  }
  for (int i = 0; i < MIEN_LANDMARK_COUNT; ++i) {
    EXPECT_NEAR(a.landmarks[i][0], b.landmarks[i][0], pixels) << i;
    EXPECT_NEAR(a.landmarks[i][1], b.landmarks[i][1], pixels) << i;
  }
}

TEST(Equivariance, InterleavedFormatsAreTheSamePicture) {
  const Result rgb = after_frames({});
  for (mien_image_format format : {MIEN_IMAGE_BGR, MIEN_IMAGE_RGBA, MIEN_IMAGE_BGRA}) {
    expect_close(after_frames({.format = format}), rgb, 1e-3f, 1e-4f);
  }
}

TEST(Equivariance, YuvIsTheSamePictureUpToChromaDetail) {
  const Result rgb = after_frames({});
  for (mien_image_format format : {MIEN_IMAGE_NV12, MIEN_IMAGE_NV21, MIEN_IMAGE_I420}) {
    for (bool full_range : {true, false}) {
      SCOPED_TRACE(testing::Message() << format << (full_range ? " full" : " video"));
      expect_close(after_frames({.format = format, .full_range = full_range}), rgb, 0.5f, 0.03f);
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

TEST(Equivariance, GreyIsGreyInEveryFormat) {
  const Result rgb = after_frames({}, true);
  for (mien_image_format format : {MIEN_IMAGE_GRAY8, MIEN_IMAGE_NV12, MIEN_IMAGE_I420}) {
    for (bool full_range : {true, false}) {
      SCOPED_TRACE(testing::Message() << format << (full_range ? " full" : " video"));
      expect_close(after_frames({.format = format, .full_range = full_range}, true), rgb, 0.1f,
                   0.01f);
    }
  }
}

TEST(Equivariance, ColourIsNotIgnored) {
  const Result colour = after_frames({});
  const Result grey = after_frames({}, true);
  float difference = 0.0f;
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    difference = std::max(difference, std::abs(colour.controls[i] - grey.controls[i]));
  }
  EXPECT_GT(difference, 1e-4f) << "or the tests above see nothing of channel order";
}

TEST(Equivariance, StridesChangeNothing) {
  for (mien_image_format format :
       {MIEN_IMAGE_GRAY8, MIEN_IMAGE_RGB, MIEN_IMAGE_BGRA, MIEN_IMAGE_NV12, MIEN_IMAGE_I420}) {
    SCOPED_TRACE(format);
    const Result tight = after_frames({.format = format});
    expect_same(after_frames({.format = format, .row_padding_bytes = 13}), tight);
    expect_same(after_frames({.format = format, .bottom_up = true}), tight);
    expect_same(after_frames({.format = format, .row_padding_bytes = 7, .bottom_up = true}), tight);
  }
}

TEST(Equivariance, RotatedBuffersAreTurnedUpright) {
  for (mien_image_format format : {MIEN_IMAGE_RGB, MIEN_IMAGE_GRAY8}) {
    const Result upright = after_frames({.format = format});
    for (int rotation : {90, 180, 270}) {
      SCOPED_TRACE(rotation);
      expect_close(after_frames({.format = format, .rotation = rotation}), upright, 0.01f, 1e-3f);
    }
  }
}

TEST(Equivariance, MirroredBuffersShowTheSameSubject) {
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

// The tracker sees the head at the place where the disc is: projecting its origin gives the crop's
// point that the decoder named.
TEST(Equivariance, FocalLengthScalesDistanceOnly) {
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
