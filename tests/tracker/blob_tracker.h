// A tracker with the test networks of blob_weights.h, which track discs.
#pragma once

#include <gtest/gtest.h>
#include <mien/mien.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "tests/tracker/blob_weights.h"
#include "tests/tracker/picture.h"

namespace mien::tests {

inline constexpr std::int64_t kFrameNs = 33'333'333;

// Copies weight files of any alignment.
inline Weights weights_of(std::initializer_list<std::span<const std::byte>> files) {
  Weights weights;
  EXPECT_EQ(weights.create(std::vector(files), true), MIEN_OK);
  return weights;
}

// A configuration that owns its weights.
struct BlobConfig : Config {
  explicit BlobConfig(const Weights& shared) : Config(shared), shared_weights(shared) {}

  // Uses other weights.
  void use(const Weights& shared) {
    shared_weights = shared;
    weights = shared_weights.get();
  }

  Weights shared_weights;
};

inline BlobConfig blob_config(const AlignedBytes& basenet, const AlignedBytes& proposal) {
  return BlobConfig(weights_of({basenet.get(), proposal.get()}));
}
inline BlobConfig blob_config(const AlignedBytes& basenet, const AlignedBytes& proposal,
                              const AlignedBytes& hifinet) {
  return BlobConfig(weights_of({basenet.get(), proposal.get(), hifinet.get()}));
}

// With audio.
inline BlobConfig blob_config(const AlignedBytes& basenet, const AlignedBytes& proposal,
                              const AlignedBytes& hifinet, const AlignedBytes& audionet) {
  return BlobConfig(weights_of({basenet.get(), proposal.get(), hifinet.get(), audionet.get()}));
}

class BlobTracker {
 public:
  explicit BlobTracker(const BlobOptions& options = {})
      : BlobTracker(options, [](mien_tracker_config&) {}) {}

  template <typename Change>
  BlobTracker(const BlobOptions& options, Change change) {
    BlobConfig config = blob_config(blob_basenet(options), blob_proposal(options),
                                    blob_hifinet(options), blob_audionet());
    change(config);
    EXPECT_EQ(tracker_.create(config), MIEN_OK);
  }

  // Pushes the next image, 1/30 s after the previous frame.
  Result push(const mien_image& image) {
    pts_ns_ += kFrameNs;
    return push(image, pts_ns_);
  }
  Result push(const mien_image& image, std::int64_t pts_ns) {
    pts_ns_ = pts_ns;
    EXPECT_EQ(tracker_.push_video(image, pts_ns), MIEN_OK);
    return result();
  }
  Result push(const Picture& picture, const Layout& layout = {}) {
    return push(Buffer(picture, layout).image());
  }

  // Pushes the same image until a detection, which may be spread over several images, finds the
  // face.
  Result push_until_found(const Picture& picture) {
    constexpr int kMaxImages = 80;
    Result result = push(picture);
    for (int i = 1; !result.has_face() && i < kMaxImages; ++i) {
      result = push(picture);
    }
    EXPECT_TRUE(result.flags & MIEN_RESULT_FOUND);
    return result;
  }

  // Outputs the next frame without an image.
  Result advance() {
    pts_ns_ += kFrameNs;
    EXPECT_EQ(tracker_.advance(pts_ns_), MIEN_OK);
    return result();
  }
  [[nodiscard]] std::int64_t now_ns() const { return pts_ns_; }

  [[nodiscard]] Result result() const {
    Result result;
    EXPECT_EQ(tracker_.get_result(result), MIEN_OK);
    return result;
  }

  Tracker& tracker() { return tracker_; }

 private:
  Tracker tracker_;
  std::int64_t pts_ns_ = 0;
};

inline Picture disc_picture(float x, float y, float diameter, int width = 320, int height = 240) {
  Picture picture(width, height);
  picture.disc(x, y, diameter);
  return picture;
}

// The largest difference of a control between two results.
inline float largest_step(const Result& a, const Result& b) {
  float largest = 0.0f;
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    largest = std::max(largest, std::abs(a.controls[i] - b.controls[i]));
  }
  return largest;
}

// Checks that all numbers of the result are finite and in range.
inline void expect_valid(const Result& result) {
  EXPECT_GE(result.status, MIEN_FACE_SEARCHING);
  EXPECT_LE(result.status, MIEN_FACE_LOST);
  const auto unit = [](float value) { return value >= 0.0f && value <= 1.0f; };
  EXPECT_TRUE(unit(result.face_probability));
  for (float control : result.controls) {
    EXPECT_TRUE(unit(control)) << control;
  }
  const float* first = result.box;
  const float* last = result.translation + 3;
  EXPECT_TRUE(std::all_of(first, last, [](float value) { return std::isfinite(value); }));
  for (const auto& point : result.landmarks) {
    EXPECT_TRUE(std::isfinite(point[0]) && std::isfinite(point[1]));
  }
  if (result.has_face()) {
    float length = 0.0f;
    for (float part : result.rotation) {
      length += part * part;
    }
    EXPECT_NEAR(length, 1.0f, 1e-4f);
  }
}

}  // namespace mien::tests
