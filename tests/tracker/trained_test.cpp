// The trained networks on the clip that ships with the repository.
#include <gtest/gtest.h>
#include <mien/mien.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 360;
constexpr std::int64_t kFps = 30;

using Frame = std::vector<unsigned char>;  // RGB

std::vector<Frame> decode(const std::string& filter) {
  const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight);
  const std::string command = "ffmpeg -v error -i " MIEN_SOURCE_DIR "/tests/data/demo.mp4 -vf " +
                              filter + "scale=" + size +
                              " -r 30 -frames:v 150 -f rawvideo -pix_fmt rgb24 - 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::vector<Frame> frames;
  Frame frame(3 * kWidth * kHeight);
  while (pipe && std::fread(frame.data(), 1, frame.size(), pipe.get()) == frame.size()) {
    frames.push_back(frame);
  }
  return frames;
}

std::vector<std::byte> read_model(const char* name) {
  std::ifstream file(std::string(MIEN_SOURCE_DIR "/models/") + name,
                     std::ios::binary | std::ios::ate);
  std::vector<std::byte> bytes(file ? static_cast<std::size_t>(file.tellg()) : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

Image image_of(const Frame& frame) {
  Image image;
  image.format = MIEN_IMAGE_RGB;
  image.width = kWidth;
  image.height = kHeight;
  image.planes[0] = frame.data();
  image.row_stride_bytes[0] = 3 * kWidth;
  return image;
}

class Trained : public testing::Test {
 protected:
  void SetUp() override {
    basenet_ = std::make_unique<AlignedBytes>(read_model("basenet.mien"));
    proposal_ = std::make_unique<AlignedBytes>(read_model("proposal.mien"));
    frames_ = decode("");
    if (basenet_->get().empty() || proposal_->get().empty()) {
      GTEST_SKIP() << "SKIPPED: models/basenet.mien and models/proposal.mien are not both there";
    }
    if (frames_.empty()) {
      GTEST_SKIP() << "SKIPPED: tests/data/demo.mp4 or the ffmpeg program is not there";
    }
  }

  std::vector<Result> track(const std::vector<Frame>& frames, bool mirrored = false) {
    Tracker tracker;
    EXPECT_EQ(tracker.create(blob_config(*basenet_, *proposal_)), MIEN_OK);
    std::vector<Result> results(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Image image = image_of(frames[i]);
      image.mirrored = mirrored;
      const auto pts = static_cast<std::int64_t>(i) * 1'000'000'000 / kFps;
      EXPECT_EQ(tracker.push_video(image, pts), MIEN_OK);
      EXPECT_EQ(tracker.get_result(results[i]), MIEN_OK);
      expect_sane(results[i]);
    }
    return results;
  }

  std::unique_ptr<AlignedBytes> basenet_;
  std::unique_ptr<AlignedBytes> proposal_;
  std::vector<Frame> frames_;
};

TEST_F(Trained, TracksTheClipAndRarelyProposes) {
  const std::vector<Result> results = track(frames_);
  const Result& last = results.back();
  EXPECT_GE(static_cast<double>(last.face_frames), 0.98 * static_cast<double>(last.frames));
  EXPECT_LT(static_cast<double>(last.proposal_runs), 0.05 * static_cast<double>(last.frames));
  EXPECT_GT(last.supported_controls, 0u);
}

TEST_F(Trained, SomethingHappensInTheFace) {
  const std::vector<Result> results = track(frames_);
  std::array<float, MIEN_CONTROL_COUNT> lowest;
  std::array<float, MIEN_CONTROL_COUNT> highest;
  lowest.fill(1.0f);
  highest.fill(0.0f);
  for (const Result& result : results) {
    for (std::size_t i = 0; i < lowest.size(); ++i) {
      lowest[i] = std::min(lowest[i], result.controls[i]);
      highest[i] = std::max(highest[i], result.controls[i]);
    }
  }
  // Of the clip's larger motions, those that these weights claim to drive.
  for (const std::size_t control : {std::size_t{17}, std::size_t{0}}) {
    const char* name = mien_control_name(static_cast<std::int32_t>(control));
    if (results.back().supports(static_cast<std::int32_t>(control))) {
      EXPECT_GT(highest[control] - lowest[control], 0.2f) << name;
    } else {
      std::printf("not looked at: these weights do not drive %s\n", name);
    }
  }
}

// Forehead, chin and eye corners lie where they do in an upright face, and the head is in front of
// the camera.
TEST_F(Trained, TheFaceIsUprightAndInFront) {
  const Result result = track(frames_)[frames_.size() / 2];
  ASSERT_TRUE(result.has_face());
  EXPECT_LT(result.translation[2], -0.1f);
  EXPECT_GT(result.translation[2], -5.0f);
  EXPECT_LT(std::abs(result.roll), 0.8f);
  EXPECT_LT(std::abs(result.pitch), 0.8f);
  for (const auto& point : result.landmarks) {
    EXPECT_GT(point[0], result.box[0] - 0.2f * result.box[2]);
    EXPECT_LT(point[0], result.box[0] + 1.2f * result.box[2]);
    EXPECT_GT(point[1], result.box[1] - 0.2f * result.box[3]);
    EXPECT_LT(point[1], result.box[1] + 1.2f * result.box[3]);
  }
}

TEST_F(Trained, AMirroredClipThatSaysSoGivesTheSameAnimation) {
  const std::vector<Result> plain = track(frames_);
  const std::vector<Result> mirrored = track(decode("hflip,"), true);
  ASSERT_EQ(plain.size(), mirrored.size());
  double difference = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    for (int k = 0; k < MIEN_CONTROL_COUNT; ++k) {
      difference += std::abs(plain[i].controls[k] - mirrored[i].controls[k]);
    }
  }
  EXPECT_LT(difference / static_cast<double>(plain.size() * MIEN_CONTROL_COUNT), 0.01);
}

}  // namespace
}  // namespace mien::tests
