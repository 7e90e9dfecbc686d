// Tests of the values in animations: numbers, rotations, controls of other vocabularies, visemes
// and resampling.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/base64.h"
#include "apps/animation/facs_map.h"
#include "apps/animation/frames_jsonl.h"
#include "apps/animation/json.h"
#include "apps/animation/numbers.h"
#include "apps/animation/resample.h"
#include "apps/animation/rotation.h"
#include "formats/vocabulary/visemes.h"
#include "tests/apps/animation/random_clip.h"

namespace mien::animation {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

TEST(Animation, FloatsRoundTrip) {
  std::mt19937 random(4);
  for (int i = 0; i < 300000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(value)) {
      EXPECT_EQ(static_cast<float>(decimal(value)), value);
    }
  }
  EXPECT_EQ(shortest(decimal(0.1f)), "0.1");
  EXPECT_EQ(fixed(-1e-12, 3), "0.000");
}

TEST(Animation, NumbersMustBeComplete) {
  double value = 7.0;
  for (const char* text :
       {"", " ", "nan", "inf", "-inf", "0x1", "1,5", "1e999", "1 2", "+1", "."}) {
    EXPECT_FALSE(parse_number(text, value)) << text;
  }
  EXPECT_EQ(value, 7.0);
  EXPECT_TRUE(parse_number(" -1.5e1\t", value));
  EXPECT_EQ(value, -15.0);
}

TEST(Animation, Base64) {
  for (const std::string bytes : {"", "f", "fo", "foo", "foob", "\xFB\xFF\xFE"}) {
    std::string back = "x";
    EXPECT_TRUE(parse_base64(base64(bytes), back));
    EXPECT_EQ(back, bytes);
  }
  std::string back = "x";
  for (const char* bad : {"Z", "Zg=", "Zg", "Z===", "Zg==Zg==", "Zm9v\n", "Zm-v"}) {
    EXPECT_FALSE(parse_base64(bad, back)) << bad;
  }
  EXPECT_EQ(back, "x");
}

TEST(Animation, JsonIsParsedStrictly) {
  JsonDocument document;
  Fault fault;
  ASSERT_TRUE(document.parse(
      R"( {"a":[1,-2.5e1,true,null],"b":"\u00e4\ud83d\ude00\n","\u0063":{}} )", fault));
  const JsonValue root = document.root();
  EXPECT_EQ(root.find("b")->text(), "\xC3\xA4\xF0\x9F\x98\x80\n");
  EXPECT_TRUE(root.find("c")->empty()) << "keys may have escapes";
  EXPECT_FALSE(root.find("d"));
  std::vector<JsonValue::Kind> kinds;
  for (const JsonValue item : root.find("a")->items()) {
    kinds.push_back(item.kind());
  }
  using enum JsonValue::Kind;
  EXPECT_THAT(kinds, ElementsAre(kNumber, kNumber, kBoolean, kNull));
  EXPECT_EQ((*++root.find("a")->items().begin()).number(), -25.0);
  for (const char* bad : {"",
                          "{",
                          "[1,]",
                          "[1 2]",
                          "{\"a\":1,}",
                          "{'a':1}",
                          "01",
                          "1.",
                          ".5",
                          "-",
                          "+1",
                          "nul",
                          "\"\\x\"",
                          "\"\\ud800\"",
                          "\"\\u12g4\"",
                          "\"a",
                          "\"\t\"",
                          "{} {}",
                          "{\"a\":1,\"a\":2}",
                          "{\"a\":1,\"b\":2,\"\\u0061\":2}",
                          "NaN",
                          "1e999"}) {
    EXPECT_FALSE(document.parse(bad, fault)) << bad;
  }
  EXPECT_FALSE(document.parse(std::string(1000, '['), fault));
  EXPECT_FALSE(document.parse("{\"a\":\n [1,\n  x]}", fault));
  EXPECT_EQ(describe(fault), "line 3, column 3: invalid value");
  std::int64_t large = 0;
  ASSERT_TRUE(document.parse("9007199254740993", fault));
  EXPECT_TRUE(document.root().integer(large));
  EXPECT_EQ(large, 9007199254740993) << "more than a double can represent";
}

TEST(Animation, RotationsRoundTrip) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-3.1, 3.1), pitch(-1.57, 1.57);
  for (int i = 0; i < 10000; ++i) {
    const Angles before = {pitch(random), angle(random), angle(random)};
    const Angles after = animation::angles(quaternion(before));
    EXPECT_NEAR(after.pitch, before.pitch, 1e-6);
    EXPECT_NEAR(after.yaw, before.yaw, 1e-6);
    EXPECT_NEAR(after.roll, before.roll, 1e-6);
  }
  for (const double pole : {std::acos(0.0), -std::acos(0.0)}) {
    const Quaternion q = quaternion({pole, 0.7, 0.0});
    const Angles there = animation::angles(q);
    EXPECT_NEAR(there.pitch, pole, 1e-7);
    EXPECT_NEAR(there.yaw, 0.7, 1e-6);
    EXPECT_EQ(there.roll, 0.0);
  }
  EXPECT_NEAR(between({0, 3.0, 0}, {0, -3.0, 0}, 0.5).yaw, std::acos(-1.0), 1e-9)
      << "the shorter way crosses half a turn";
}

TEST(Animation, FacsMapKeepsCommonValues) {
  const Clip clip = random_clip(1000, 6);
  for (const Frame& frame : clip.frames) {
    const auto facs = facs_of(frame.controls);
    const auto back = controls_of_facs(facs);
    for (const std::string_view same :
         {"eyeBlinkLeft", "jawOpen", "mouthClose", "mouthPucker", "mouthSmileRight", "browInnerUp",
          "cheekPuff", "tongueOut"}) {
      const std::size_t i = formats::index_of(same, formats::kArkitNames);
      EXPECT_EQ(back[i], frame.controls[i]) << same;
    }
    EXPECT_FALSE(formats::driven(back[formats::control("jawForward")]));
    // Idempotent: repeating the conversion changes nothing.
    const auto again = facs_of(controls_of_facs(facs_of(back)));
    const auto once = facs_of(back);
    for (std::size_t i = 0; i < formats::kFacsCount; ++i) {
      EXPECT_EQ(formats::driven(again[i]), formats::driven(once[i]));
      EXPECT_EQ(formats::or_zero(again[i]), formats::or_zero(once[i]));
      EXPECT_TRUE(formats::or_zero(once[i]) >= 0.0 && formats::or_zero(once[i]) <= 1.0);
    }
  }
}

std::string mirrored(std::string_view name) {
  std::string other(name);
  const auto swap = [&](const std::string& a, const std::string& b) {
    const std::size_t at = other.find(a);
    if (at == std::string::npos) {
      return false;
    }
    other.replace(at, a.size(), b);
    return true;
  };
  if (!swap("Left", "Right")) {
    swap("Right", "Left");
  }
  return other;
}

TEST(Animation, FacsMapCommutesWithTheMirror) {
  const Clip clip = random_clip(100, 7);
  for (const Frame& frame : clip.frames) {
    std::array<double, formats::kControlCount> turned{};
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      turned[formats::index_of(mirrored(formats::kArkitNames[i]), formats::kArkitNames)] =
          frame.controls[i];
    }
    const auto facs = facs_of(frame.controls), of_turned = facs_of(turned);
    for (std::size_t i = 0; i < formats::kFacsCount; ++i) {
      const std::size_t other =
          formats::index_of(mirrored(formats::kFacsNames[i]), formats::kFacsNames);
      ASSERT_LT(other, formats::kFacsCount) << formats::kFacsNames[i];
      EXPECT_EQ(formats::or_zero(of_turned[other]), formats::or_zero(facs[i]))
          << formats::kFacsNames[i];
    }
  }
}

TEST(Animation, APoseIsItsOwnViseme) {
  for (std::size_t i = 0; i < formats::kVisemeCount; ++i) {
    std::array<double, formats::kVisemeCount> one{};
    one[i] = 1.0;
    const auto back = formats::visemes_of(formats::controls_of_visemes(one));
    for (std::size_t k = 0; k < formats::kVisemeCount; ++k) {
      EXPECT_NEAR(back[k], k == i ? 1.0 : 0.0, 1e-9) << formats::kVisemeNames[i];
    }
  }
  for (const char shape : formats::kMouthShapes) {
    EXPECT_EQ(formats::mouth_shape_of(formats::visemes_of_mouth_shape(shape)), shape);
  }
  Frame nothing;
  EXPECT_FALSE(formats::driven(formats::visemes_of(nothing.controls)[0]));
  EXPECT_EQ(formats::mouth_shape_of(formats::visemes_of(nothing.controls)), 'X');
}

// No change of a single weight brings the mixture nearer to the mouth, as least squares guarantees.
TEST(Animation, VisemesAreTheNearestMixture) {
  const Clip clip = random_clip(300, 8);
  for (const Frame& frame : clip.frames) {
    const auto visemes = formats::visemes_of(frame.controls);
    double sum = 0.0;
    for (const double weight : visemes) {
      EXPECT_GE(weight, 0.0);
      sum += weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    if (visemes[0] == 0.0) {
      continue;  // normalized to 1
    }
    const auto distance = [&](const std::array<double, formats::kVisemeCount>& weights) {
      const auto pose = formats::controls_of_visemes(weights);
      double squares = 0.0;
      for (std::size_t i = 0; i < formats::kControlCount; ++i) {
        squares += formats::driven(pose[i])
                       ? (pose[i] - frame.controls[i]) * (pose[i] - frame.controls[i])
                       : 0;
      }
      return squares;
    };
    const double min = distance(visemes);
    for (std::size_t i = 1; i < formats::kVisemeCount; ++i) {
      for (const double change : {-1e-3, 1e-3}) {
        auto other = visemes;
        other[i] = std::max(0.0, other[i] + change);
        EXPECT_GE(distance(other), min - 1e-12);
      }
    }
  }
}

TEST(Animation, ResamplingAtTheSameTimesIsTheIdentity) {
  const Clip clip = random_clip(50, 9);
  const std::vector<Frame> same = resampled(clip.frames, 25.0, 0).unpacked();
  const std::vector<Frame> frames = clip.frames.unpacked();
  ASSERT_EQ(same.size(), frames.size());
  for (std::size_t i = 0; i < same.size(); ++i) {
    EXPECT_EQ(frame_json(same[i]), frame_json(frames[i]));
  }
  const std::vector<Frame> twice = resampled(clip.frames, 50.0, 0).unpacked();
  ASSERT_EQ(twice.size(), 99u);
  EXPECT_EQ(frame_json(twice[0]).substr(20), frame_json(same[0]).substr(20));
  EXPECT_NEAR(twice[1].controls.front(),
              (same[0].controls.front() + same[1].controls.front()) / 2.0, 1e-15);
  EXPECT_TRUE(resampled(FrameSequence(), 25.0, 0).empty());
  const FrameSequence later({frames.begin() + 3, frames.end()});
  EXPECT_EQ(resampled(later, 10.0, 0).first_time_ns(), 200'000'000)
      << "the first grid time after 120 ms";
}

TEST(Animation, VocabulariesHaveNoDuplicates) {
  const auto check = [](const auto& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_EQ(formats::index_of(names[i], names), i) << names[i];
      EXPECT_FALSE(names[i].empty());
    }
  };
  check(formats::kArkitNames);
  check(formats::kRotationNames);
  check(formats::kMediaPipeNames);
  check(formats::kFacsNames);
  check(formats::kFacsLevel1Names);
  check(formats::kVisemeNames);
  check(formats::kReadyPlayerMeNames);
  check(formats::kVrm0Names);
  check(formats::kVrm1Names);
  for (const std::string_view name : formats::kMediaPipeNames) {
    EXPECT_TRUE(name == "_neutral" ||
                formats::index_of(name, formats::kArkitNames) < formats::kControlCount)
        << name;
  }
  EXPECT_THAT(formats::kMediaPipeNames, Not(Contains("tongueOut")));
}

}  // namespace
}  // namespace mien::animation
