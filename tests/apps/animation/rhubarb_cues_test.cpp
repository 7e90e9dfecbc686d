// Tests of mouth cues derived from an animation: the duration that a shape needs.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/animation/rhubarb.h"

namespace mien::animation {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;

// 'D' for a fifth of a second, another shape for `frames` frames, and 'D' again, at 100 frames per
// second.
std::string cues_with_shape_for(int frames, RhubarbForm form) {
  const auto writer = rhubarb_writer(form, "speech.wav");
  std::string text = writer->begin();
  const auto add = [&](std::int64_t number, char shape) {
    Frame frame;
    frame.number = number;
    frame.time_ns = number * kStep_ns;
    frame.mouth_shape = shape;
    frame.controls.fill(0.0);
    text += writer->frame(frame);
  };
  for (int number = 0; number < 40; ++number) {
    add(number, number >= 20 && number < 20 + frames ? 'F' : 'D');
  }
  add(40, '\0');  // makes it an animation: a file of cues would be written as it was read
  return text + writer->finish();
}

TEST(RhubarbCues, AShapeNeedsEightyMillisecondsToBecomeACue) {
  for (const int frames : {1, 4, 6, 7}) {
    EXPECT_EQ(cues_with_shape_for(frames, RhubarbForm::kTsv).find('F'), std::string::npos)
        << frames * 10 << " ms";
  }
  for (const int frames : {8, 9, 12}) {
    const std::string end = std::to_string(20 + frames);
    EXPECT_NE(
        cues_with_shape_for(frames, RhubarbForm::kTsv).find("0.00\tD\n0.20\tF\n0." + end + "\tD\n"),
        std::string::npos)
        << frames * 10 << " ms";
    EXPECT_NE(cues_with_shape_for(frames, RhubarbForm::kJson)
                  .find(R"("start": 0.20, "end": 0.)" + end + R"(, "value": "F")"),
              std::string::npos);
  }
}

// The previous shape continues in place of a short one.
TEST(RhubarbCues, AShortShapeLeavesNoGap) {
  EXPECT_EQ(cues_with_shape_for(4, RhubarbForm::kTsv).substr(0, 12), "0.00\tD\n0.41\t");
}

}  // namespace
}  // namespace mien::animation
