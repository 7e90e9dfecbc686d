// Tests of tracking in a region of a larger image.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

constexpr int kImageWidth = 640, kImageHeight = 480;
constexpr float kDiscDiameter = 40.0f;

using Region = std::array<int, 4>;  // x, y, width, height

Result push_region(BlobTracker& tracker, const Region& region, float x, float y) {
  const Picture picture = disc_picture(x, y, kDiscDiameter, kImageWidth, kImageHeight);
  const Buffer buffer(picture, {});
  mien_image image = buffer.image();
  std::copy(region.begin(), region.end(), std::begin(image.region));
  return tracker.push(image);
}

// A face at every edge of a region in every corner of the image.
TEST(Region, FacesAreDetectedAndTrackedAnywhereInIt) {
  for (const int left : {0, 420}) {
    for (const int top : {0, 260}) {
      const Region region = {left, top, 200, 180};
      for (const float x : {40.0f, 160.0f}) {
        for (const float y : {40.0f, 140.0f}) {
          const float scene_x = static_cast<float>(left) + x;
          const float scene_y = static_cast<float>(top) + y;
          SCOPED_TRACE(testing::Message() << scene_x << ", " << scene_y);
          BlobTracker tracker;
          Result result;
          for (int frame = 0; frame < 6; ++frame) {
            result = push_region(tracker, region, scene_x, scene_y);
          }
          ASSERT_TRUE(result.has_face());
          EXPECT_EQ(result.proposal_runs, 1u) << "the face was never lost";
          EXPECT_NEAR(result.box[0] + result.box[2] / 2, scene_x, 2.0f);
          EXPECT_NEAR(result.box[1] + result.box[3] / 2, scene_y, 2.0f);
        }
      }
    }
  }
}

// The tracker does not track a face outside the region.
TEST(Region, LosesAFaceThatLeavesIt) {
  const Region region = {300, 200, 200, 180};
  constexpr float kSide = kDiscDiameter / kDiscPerCrop;
  constexpr float kStep = 3.0f;
  for (const auto& [dx, dy] : {std::pair{1.0f, 0.0f}, {-1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, -1.0f}}) {
    SCOPED_TRACE(testing::Message() << dx << ", " << dy);
    BlobTracker tracker;
    float x = 400.0f, y = 290.0f;
    Result result = push_region(tracker, region, x, y);
    ASSERT_TRUE(result.has_face());
    for (int frame = 0; frame < 60 && result.has_face(); ++frame) {
      x += kStep * dx;
      y += kStep * dy;
      result = push_region(tracker, region, x, y);
      const float center_x = result.box[0] + result.box[2] / 2;
      const float center_y = result.box[1] + result.box[3] / 2;
      EXPECT_GE(center_x, 300.0f - kSide / 2);
      EXPECT_LE(center_x, 500.0f + kSide / 2);
      EXPECT_GE(center_y, 200.0f - kSide / 2);
      EXPECT_LE(center_y, 380.0f + kSide / 2);
    }
    EXPECT_FALSE(result.has_face());
  }
}

}  // namespace
}  // namespace mien::tests
