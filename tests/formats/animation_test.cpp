// Tests of properties that all animation formats share: readers survive any input, errors have a
// position, and derived values are consistent.
#include "apps/animation/animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>

#include "apps/animation/base64.h"
#include "apps/animation/facs_map.h"
#include "apps/animation/frames_jsonl.h"
#include "apps/animation/json.h"
#include "apps/animation/numbers.h"
#include "apps/animation/resample.h"
#include "apps/animation/rotation.h"
#include "formats/vocabulary/visemes.h"

namespace mien::formats {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

double share(std::mt19937& random) {
  return std::uniform_int_distribution(0, 9)(random) == 0
             ? 0.0
             : std::uniform_real_distribution(0.0, 1.0)(random);
}

Clip random_clip(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  Clip clip;
  for (std::size_t i = 0; i < count; ++i) {
    Frame frame;
    frame.number = static_cast<std::int64_t>(i);
    frame.time_ns = static_cast<std::int64_t>(i) * 40'000'000;
    for (double& value : frame.controls) {
      value = share(random);
    }
    frame.head = {share(random), share(random), -share(random)};
    frame.position_m = {share(random), share(random), share(random)};
    clip.frames.push_back(frame);
  }
  return clip;
}

std::string written(const Clip& clip, AnimationFormat format) {
  const auto writer = animation_writer(format, {});
  std::string text = writer->begin();
  for (const Frame& frame : clip.frames) {
    text += writer->frame(frame);
  }
  return text + writer->finish();
}

TEST(Animation, EndingAndContentDetermineTheFormat) {
  const Clip clip = random_clip(20, 1);
  for (const FormatName& known : kFormatNames) {
    EXPECT_EQ(format_named(known.name), known.format);
    EXPECT_EQ(format_by_ending("a/b" + std::string(known.ending)), known.format) << known.ending;
    const std::string text = written(clip, known.format);
    const AnimationFormat seen = format_by_content(text);
    EXPECT_EQ(seen, known.format) << known.name;
    Clip read;
    Fault fault;
    EXPECT_TRUE(read_animation(seen, text, {}, read, fault)) << known.name << describe(fault);
    EXPECT_FALSE(read.frames.empty());
  }
  EXPECT_EQ(format_by_ending("clip.mp4"), std::nullopt);
  EXPECT_EQ(format_by_ending(".csv"), std::nullopt) << "a hidden file without an ending";
}

std::string read_and_written(const std::string& text, AnimationFormat format) {
  Clip read;
  Fault fault;
  EXPECT_TRUE(read_animation(format, text, {}, read, fault)) << describe(fault);
  return written(read, format);
}

TEST(Animation, AByteOrderMarkIsIgnored) {
  const Clip clip = random_clip(5, 9);
  for (const FormatName& known : kFormatNames) {
    if (known.format == AnimationFormat::kGlb) {
      continue;  // not a text format
    }
    const std::string text = written(clip, known.format);
    const std::string marked = "\xEF\xBB\xBF" + text;
    EXPECT_EQ(format_by_content(marked), known.format) << known.name;
    EXPECT_EQ(read_and_written(marked, known.format), read_and_written(text, known.format))
        << known.name;
  }
}

Clip clip_from(std::int64_t begin_ns) {
  Clip clip = random_clip(20, 10);
  std::vector<Frame> frames = clip.frames.unpacked();
  for (Frame& frame : frames) {
    frame.time_ns += begin_ns;
  }
  clip.frames = FrameSequence(frames);
  return clip;
}

// Nanoseconds since 1970, a camera that started before the audio, and a clip.
TEST(Animation, TimesOfAnyOriginRoundTrip) {
  constexpr std::int64_t kSince1970_ns = 1'700'000'000'033'250'000;
  for (const std::int64_t begin_ns : {kSince1970_ns, std::int64_t{-500'000'000}, std::int64_t{0}}) {
    const Clip clip = clip_from(begin_ns);
    for (const FormatName& known : kFormatNames) {
      SCOPED_TRACE(std::string(known.name) + " from " + std::to_string(begin_ns) + " ns on");
      const std::string text = written(clip, known.format);
      const std::string again = read_and_written(text, known.format);
      const bool over_angles =
          known.format == AnimationFormat::kGltf || known.format == AnimationFormat::kGlb;
      EXPECT_TRUE(over_angles || again == text) << text << again;
    }
  }
}

TEST(Animation, TimesKeepTheirDigits) {
  Clip clip;
  Fault fault;
  ASSERT_TRUE(read_animation(AnimationFormat::kCsv,
                             "t_ms,jawOpen\n1700000000033.25,0\n1700000000066.5,0\n", {}, clip,
                             fault))
      << describe(fault);
  EXPECT_EQ(clip.frames.unpacked()[0].time_ns, 1'700'000'000'033'250'000);
  EXPECT_EQ(clip.frames.unpacked()[0].time_ms(), 1700000000033.25);
  EXPECT_EQ(clip.frames.unpacked()[1].time_ns, 1'700'000'000'066'500'000);
  ASSERT_TRUE(read_animation(AnimationFormat::kRhubarbDat,
                             "MohoSwitch1\n40800000002 A\n40800000003 X\n", {}, clip, fault))
      << describe(fault);
  EXPECT_EQ(clip.frames.unpacked()[0].time_ns, 1'700'000'000'041'666'667);
  EXPECT_EQ(written(clip, AnimationFormat::kRhubarbDat),
            "MohoSwitch1\n40800000002 A\n40800000003 X\n");
}

// Cues count from the start of the audio; a clip that starts earlier is shifted, and a loss is
// reported.
TEST(Animation, CuesBeginAtZero) {
  const Clip clip = clip_from(-500'000'000), moved = clip_from(0);
  for (const AnimationFormat format :
       {AnimationFormat::kRhubarb, AnimationFormat::kRhubarbJson, AnimationFormat::kRhubarbXml,
        AnimationFormat::kRhubarbDat}) {
    EXPECT_EQ(written(clip, format), written(moved, format));
    EXPECT_THAT(losses(clip, format), Contains(HasSubstr("times before 0")));
    EXPECT_THAT(losses(moved, format), Not(Contains(HasSubstr("times before 0"))));
  }
}

// Writers neither overflow nor hang for any allowed times.
TEST(Animation, WritersAcceptTheLargestTimes) {
  constexpr std::int64_t kLast = kLastTime_ns;
  for (const std::vector<std::int64_t>& times :
       std::vector<std::vector<std::int64_t>>{{-kLast, 0, kLast},
                                              {-kLast, 1'000'000'000, kLast},
                                              {-kLast, kLast},
                                              {kLast},
                                              {-kLast},
                                              {kLast, kLast},
                                              {-kLast, -kLast, kLast - 1, kLast}}) {
    Clip clip;
    std::vector<Frame> frames = random_clip(times.size(), 11).frames.unpacked();
    for (std::size_t i = 0; i < times.size(); ++i) {
      frames[i].time_ns = times[i];
    }
    for (const bool has_shapes : {false, true}) {
      for (Frame& frame : frames) {
        frame.mouth_shape = has_shapes ? 'B' : '\0';
      }
      clip.frames = FrameSequence(frames);
      for (const FormatName& known : kFormatNames) {
        SCOPED_TRACE(known.name);
        const std::string text = written(clip, known.format);
        static_cast<void>(losses(clip, known.format));
        // Formats that count from the first frame, or store times of day, reject these.
        if (known.format != AnimationFormat::kGltf && known.format != AnimationFormat::kGlb &&
            known.format != AnimationFormat::kBvh && known.format != AnimationFormat::kLiveLink) {
          read_and_written(text, known.format);
        }
      }
    }
  }
}

// A position in the text: a byte of a line, including its end, or the start of the next line. In a
// binary file or UTF-16: a byte, or a position in its JSON.
void expect_place(const Fault& fault, AnimationFormat format, const std::string& text) {
  SCOPED_TRACE(std::string(name(format)) + ": " + describe(fault));
  if (format == AnimationFormat::kGlb || fault.line == 0) {
    EXPECT_LE(fault.column, text.size() + 1);
    return;
  }
  std::size_t begin = 0, line = 1;
  for (std::size_t end = 0;
       line < fault.line && (end = text.find('\n', begin)) != std::string::npos; ++line) {
    begin = end + 1;
  }
  const bool behind_the_last = fault.line == line + 1 && fault.column == 1;
  EXPECT_TRUE(fault.line == line || behind_the_last);
  EXPECT_GE(fault.column, 1u);
  EXPECT_LE(fault.column, std::min(text.find('\n', begin), text.size()) - begin + 1);
}

// For every format, a file truncated anywhere or with any changed byte is read or rejected with a
// position.
TEST(Animation, ReadersSurviveAnyBytes) {
  const Clip clip = random_clip(3, 2);
  for (const FormatName& known : kFormatNames) {
    const std::string whole = written(clip, known.format);
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 300);
    for (std::size_t size = 0; size < whole.size(); size += step) {
      for (const char c : {'\0', '"', ',', '\n', '9', '-', '{', '\xFF', 'x'}) {
        for (const bool cut : {true, false}) {
          std::string text = cut ? whole.substr(0, size) : whole;
          if (!text.empty()) {
            text[std::min(size, text.size() - 1)] = c;
          }
          Clip read;
          Fault fault;
          if (!read_animation(known.format, text, {}, read, fault)) {
            EXPECT_FALSE(fault.what.empty()) << known.name;
            expect_place(fault, known.format, text);
            EXPECT_TRUE(read.frames.empty()) << "the clip stays unchanged";
          }
        }
      }
    }
  }
}

TEST(Animation, LossesAreReported) {
  Clip clip = random_clip(2, 3);
  EXPECT_THAT(losses(clip, AnimationFormat::kCsv), IsEmpty());
  EXPECT_THAT(losses(clip, AnimationFormat::kGlb), IsEmpty());
  EXPECT_THAT(losses(clip, AnimationFormat::kLiveLink), ElementsAre("head position"));
  EXPECT_THAT(losses(clip, AnimationFormat::kBvh), Contains("the controls"));
  EXPECT_THAT(losses(clip, AnimationFormat::kRoblox), Contains(HasSubstr("jawForward")));
  EXPECT_THAT(losses(clip, AnimationFormat::kRhubarb), Contains("head rotation"));
  std::vector<Frame> frames = clip.frames.unpacked();
  const auto lost = [&frames, &clip](AnimationFormat format) {
    clip.frames = FrameSequence(frames);
    return losses(clip, format);
  };
  frames[0].eyes = gaze(frames[0].controls);
  EXPECT_THAT(lost(AnimationFormat::kCsv), IsEmpty()) << "the controls contain it";
  frames[0].eyes = {Angles{0.3, 0.2, 0.1}, Angles{}};
  EXPECT_THAT(lost(AnimationFormat::kCsv), ElementsAre("eye rotation"));
  frames[1].voice_activity = 0.5;
  EXPECT_THAT(lost(AnimationFormat::kGltf), Contains(HasSubstr("voice activity")));
  EXPECT_THAT(lost(AnimationFormat::kJsonl), IsEmpty());
  frames[1].controls[index_of("eyeLookOutLeft", kArkitNames)] = kNoNumber;
  EXPECT_THAT(lost(AnimationFormat::kLiveLink), Contains(HasSubstr("become 0")));
  frames[1].time_ns += 10'000'000'000;
  frames.push_back(frames[1]);
  EXPECT_THAT(lost(AnimationFormat::kBvh), Contains(HasSubstr("become even")));
}

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
    const Angles after = angles(quaternion(before));
    EXPECT_NEAR(after.pitch, before.pitch, 1e-6);
    EXPECT_NEAR(after.yaw, before.yaw, 1e-6);
    EXPECT_NEAR(after.roll, before.roll, 1e-6);
  }
  for (const double pole : {std::acos(0.0), -std::acos(0.0)}) {
    const Quaternion q = quaternion({pole, 0.7, 0.0});
    const Angles there = angles(q);
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
      const std::size_t i = index_of(same, kArkitNames);
      EXPECT_EQ(back[i], frame.controls[i]) << same;
    }
    EXPECT_FALSE(driven(back[control("jawForward")]));
    // Idempotent: repeating the conversion changes nothing.
    const auto again = facs_of(controls_of_facs(facs_of(back)));
    const auto once = facs_of(back);
    for (std::size_t i = 0; i < kFacsCount; ++i) {
      EXPECT_EQ(driven(again[i]), driven(once[i]));
      EXPECT_EQ(or_zero(again[i]), or_zero(once[i]));
      EXPECT_TRUE(or_zero(once[i]) >= 0.0 && or_zero(once[i]) <= 1.0);
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
    std::array<double, kControlCount> turned{};
    for (std::size_t i = 0; i < kControlCount; ++i) {
      turned[index_of(mirrored(kArkitNames[i]), kArkitNames)] = frame.controls[i];
    }
    const auto facs = facs_of(frame.controls), of_turned = facs_of(turned);
    for (std::size_t i = 0; i < kFacsCount; ++i) {
      const std::size_t other = index_of(mirrored(kFacsNames[i]), kFacsNames);
      ASSERT_LT(other, kFacsCount) << kFacsNames[i];
      EXPECT_EQ(or_zero(of_turned[other]), or_zero(facs[i])) << kFacsNames[i];
    }
  }
}

TEST(Animation, APoseIsItsOwnViseme) {
  for (std::size_t i = 0; i < kVisemeCount; ++i) {
    std::array<double, kVisemeCount> one{};
    one[i] = 1.0;
    const auto back = visemes_of(controls_of_visemes(one));
    for (std::size_t k = 0; k < kVisemeCount; ++k) {
      EXPECT_NEAR(back[k], k == i ? 1.0 : 0.0, 1e-9) << kVisemeNames[i];
    }
  }
  for (const char shape : kMouthShapes) {
    EXPECT_EQ(mouth_shape_of(visemes_of_mouth_shape(shape)), shape);
  }
  Frame nothing;
  EXPECT_FALSE(driven(visemes_of(nothing.controls)[0]));
  EXPECT_EQ(mouth_shape_of(visemes_of(nothing.controls)), 'X');
}

// No change of a single weight brings the mixture nearer to the mouth, as least squares guarantees.
TEST(Animation, VisemesAreTheNearestMixture) {
  const Clip clip = random_clip(300, 8);
  for (const Frame& frame : clip.frames) {
    const auto visemes = visemes_of(frame.controls);
    double sum = 0.0;
    for (const double weight : visemes) {
      EXPECT_GE(weight, 0.0);
      sum += weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    if (visemes[0] == 0.0) {
      continue;  // normalized to 1
    }
    const auto distance = [&](const std::array<double, kVisemeCount>& weights) {
      const auto pose = controls_of_visemes(weights);
      double squares = 0.0;
      for (std::size_t i = 0; i < kControlCount; ++i) {
        squares +=
            driven(pose[i]) ? (pose[i] - frame.controls[i]) * (pose[i] - frame.controls[i]) : 0;
      }
      return squares;
    };
    const double least = distance(visemes);
    for (std::size_t i = 1; i < kVisemeCount; ++i) {
      for (const double change : {-1e-3, 1e-3}) {
        auto other = visemes;
        other[i] = std::max(0.0, other[i] + change);
        EXPECT_GE(distance(other), least - 1e-12);
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
      EXPECT_EQ(index_of(names[i], names), i) << names[i];
      EXPECT_FALSE(names[i].empty());
    }
  };
  check(kArkitNames);
  check(kRotationNames);
  check(kMediaPipeNames);
  check(kFacsNames);
  check(kFacsLevel1Names);
  check(kVisemeNames);
  check(kReadyPlayerMeNames);
  check(kVrm0Names);
  check(kVrm1Names);
  for (const std::string_view name : kMediaPipeNames) {
    EXPECT_TRUE(name == "_neutral" || index_of(name, kArkitNames) < kControlCount) << name;
  }
  EXPECT_THAT(kMediaPipeNames, Not(Contains("tongueOut")));
}

}  // namespace
}  // namespace mien::formats
