// Tests of animations in other units, separators and encodings, and of cues with gaps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/live_link_units.h"
#include "apps/animation/numbers.h"

namespace mien::animation {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Clip read(AnimationFormat format, const std::string& text, const ReadOptions& options = {}) {
  Clip clip;
  Fault fault;
  EXPECT_EQ(format_by_content(text), format) << text.substr(0, 200);
  EXPECT_TRUE(read_animation(format, text, options, clip, fault)) << describe(fault);
  return clip;
}

std::string fault_of(AnimationFormat format, const std::string& text,
                     const ReadOptions& options = {}) {
  Clip clip;
  Fault fault;
  EXPECT_FALSE(read_animation(format, text, options, clip, fault));
  return fault.what;
}

std::vector<double> times_ms(const Clip& clip) {
  std::vector<double> times;
  for (const Frame& frame : clip.frames) {
    times.push_back(frame.time_ms());
  }
  return times;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string timecode(int second, double frame) {
  const auto two_digits = [](std::string number) {
    return number.find('.', 2) == 2 || number.size() == 2 ? number : "0" + number;
  };
  return "10:00:" + two_digits(std::to_string(second)) + ":" + two_digits(fixed(frame, 3));
}

const std::string kTimes = "Timecode,BlendshapeCount,JawOpen\n";

// Rows captured at `captured` frames per second, with a timecode of `rate` frames per second.
std::string take(double rate, double captured, int count) {
  std::string text = kTimes;
  for (int i = 0; i < count; ++i) {
    const double time_s = i / captured;
    const int second = static_cast<int>(time_s + 1e-9);
    text += timecode(second, std::max((time_s - second) * rate, 0.0)) + ",61,0.5\n";
  }
  return text;
}

TEST(LiveLinkTimecode, TheLargestFrameNumberDeterminesTheRate) {
  for (const double rate : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0}) {
    for (const double captured : {rate, 60.0, rate / 2.0}) {
      const Clip clip = read(AnimationFormat::kLiveLink, take(rate, captured, 180));
      for (std::size_t i = 0; const double time : times_ms(clip)) {
        ASSERT_NEAR(time - 36e6, 1000.0 * static_cast<double>(i++) / captured, 0.05)
            << rate << " captured at " << captured;
      }
      EXPECT_THAT(clip.notes, ElementsAre(HasSubstr("detected (--from-llf-fps)")));
    }
  }
}

TEST(LiveLinkTimecode, MissingRowsChangeNothing) {
  std::string text = kTimes;
  for (int i = 0; i < 199; ++i) {
    if (i % 7 != 3 && i % 30 != 29) {  // including the last of every second
      text += timecode(i / 30, i % 30) + ",61,0.5\n";
    }
  }
  EXPECT_NEAR(times_ms(read(AnimationFormat::kLiveLink, text)).back() - 36e6, 198 / 0.03, 1e-3);
}

TEST(LiveLinkTimecode, TooFewRowsHaveTheDefaultRate) {
  const Clip clip = read(AnimationFormat::kLiveLink, take(30.0, 30.0, 20));
  EXPECT_NEAR(times_ms(clip).back() - 36e6, 1000.0 * 19 / 60, 1e-3);
  EXPECT_THAT(clip.notes, ElementsAre(HasSubstr("60 frames per second, default")));
}

TEST(LiveLinkTimecode, AnOptionOverridesDetection) {
  ReadOptions options;
  options.timecode_fps = 50.0;
  const Clip clip = read(AnimationFormat::kLiveLink, take(30.0, 30.0, 60), options);
  EXPECT_NEAR(times_ms(clip)[1] - 36e6, 20.0, 1e-6);
  EXPECT_THAT(clip.notes, IsEmpty());
  options.timecode_fps = 24.0;
  EXPECT_THAT(fault_of(AnimationFormat::kLiveLink, take(30.0, 30.0, 60), options),
              HasSubstr("more frames than a second of 24 (--from-llf-fps)"));
  EXPECT_THAT(fault_of(AnimationFormat::kLiveLink, take(100.0, 100.0, 200)),
              HasSubstr("more frames than a second of 60 (--from-llf-fps)"));
}

// One row: gaze controls, and the nine rotations in some unit.
struct Row {
  double look_up;
  std::array<double, 3> head, eye;  // yaw, pitch, roll
};

std::string angles(const std::vector<Row>& rows, double scale) {
  std::string text =
      "Timecode,BlendshapeCount,EyeLookUpLeft,EyeLookUpRight,HeadYaw,HeadPitch,HeadRoll,LeftEyeYaw,"
      "LeftEyePitch,LeftEyeRoll,RightEyeYaw,RightEyePitch,RightEyeRoll\n";
  for (int i = 0; const Row& row : rows) {
    text += timecode(i / 60, i % 60) + ",61";
    ++i;
    for (const double value : {row.look_up, row.look_up}) {
      text += "," + fixed(value, 6);
    }
    for (const auto& turn : {row.head, row.eye, row.eye}) {
      for (const double angle : turn) {
        text += "," + fixed(angle * scale, 6);
      }
    }
    text += "\n";
  }
  return text;
}

std::vector<Row> moving(double head_rad, double look) {
  std::vector<Row> rows;
  for (int i = 0; i < 120; ++i) {
    const double swing = std::sin(i / 20.0);
    const double up = look * (1.0 + swing) / 2.0;
    rows.push_back({up, {head_rad * swing, 0.3 * head_rad, 0.0}, {0.0, 0.485 * up, 0.0}});
  }
  return rows;
}

constexpr double kDegrees = 180.0 / std::numbers::pi;

TEST(LiveLinkAngles, AreDegreesWhereTheyAreTooLargeForRadians) {
  for (const double head_rad : {0.05, 0.4, 1.2}) {  // 2.9 to 69 degrees
    const std::vector<Row> rows = moving(head_rad, 0.0);
    const Clip clip = read(AnimationFormat::kLiveLink, angles(rows, kDegrees));
    EXPECT_NEAR(clip.frames.unpacked().at(25).head->yaw, rows[25].head[0], 1e-6);
    EXPECT_THAT(clip.notes, Contains("rotations: degrees, detected (--from-llf-rot)"));
  }
}

TEST(LiveLinkAngles, AreDegreesWhereStepsAreTooLargeForRadians) {
  std::vector<Row> rows(60);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].head = {(i % 2 == 0 ? 0.5 : -0.5) / kDegrees, 0.0, 0.0};
  }
  EXPECT_NEAR(
      read(AnimationFormat::kLiveLink, angles(rows, kDegrees)).frames.unpacked().at(0).head->yaw,
      0.5 / kDegrees, 1e-6);
}

TEST(LiveLinkAngles, TheEyesDetermineTheUnit) {
  const std::vector<Row> rows = moving(0.02, 0.6);
  for (const double scale : {1.0, 1.0 / std::numbers::pi, kDegrees}) {
    const Clip clip = read(AnimationFormat::kLiveLink, angles(rows, scale));
    EXPECT_NEAR(clip.frames.unpacked().at(30).head->yaw, rows[30].head[0], 4e-6) << scale;
    EXPECT_NEAR((*clip.frames.unpacked().at(30).eyes)[1].pitch, -rows[30].eye[1], 4e-6) << scale;
  }
}

TEST(LiveLinkAngles, DefaultToRadians) {
  const std::vector<Row> rows = moving(0.5, 0.0);
  const Clip clip = read(AnimationFormat::kLiveLink, angles(rows, 1.0));
  EXPECT_NEAR(clip.frames.unpacked().at(30).head->yaw, rows[30].head[0], 1e-6);
  EXPECT_THAT(clip.notes, Contains("rotations: radians, default (--from-llf-rot)"));
}

TEST(LiveLinkAngles, BeyondHalfATurnAreAFault) {
  const std::string text = angles(moving(0.4, 0.0), kDegrees);
  ReadOptions options;
  for (const RotationUnit unit : {RotationUnit::kRadians, RotationUnit::kDegreesBy180}) {
    options.rotation = unit;
    EXPECT_THAT(fault_of(AnimationFormat::kLiveLink, text, options),
                AllOf(HasSubstr("more than half a turn"), HasSubstr("--from-llf-rot")));
  }
  options.rotation = RotationUnit::kDegrees;
  EXPECT_THAT(read(AnimationFormat::kLiveLink, text, options).notes,
              Not(Contains(HasSubstr("rotations"))));
  EXPECT_THAT(fault_of(AnimationFormat::kLiveLink, angles(moving(4.0, 0.0), kDegrees)),
              HasSubstr("more than half a turn in degrees"));
}

TEST(Tables, AreReadWithAnySeparator) {
  const std::string comma = take(30.0, 30.0, 60);
  const std::vector<double> wanted = times_ms(read(AnimationFormat::kLiveLink, comma));
  for (const char* separator : {";", "\t"}) {
    const Clip clip = read(AnimationFormat::kLiveLink, with(comma, ",", separator));
    EXPECT_EQ(times_ms(clip), wanted);
    EXPECT_EQ(clip.frames.unpacked().at(0).controls[formats::control("jawOpen")], 0.5);
  }
  const std::string curves = "t_ms,jawOpen\n0,0.25\n40,0.5\n";
  for (const char* separator : {",", ";", "\t"}) {
    const Clip clip = read(AnimationFormat::kCsv, with(curves, ",", separator));
    EXPECT_EQ(clip.frames.unpacked().at(1).controls[formats::control("jawOpen")], 0.5);
  }
  // As spreadsheets write them with decimal commas.
  EXPECT_EQ(
      read(AnimationFormat::kCsv, "t_ms;jawOpen\n0;0,25\n40,5;1\n").frames.unpacked().at(1).time_ns,
      40'500'000);
  EXPECT_EQ(read(AnimationFormat::kCsv, "\"t,ms\";t_ms;jawOpen\n\"a;b\";0;1\n").frames.size(), 1);
  EXPECT_THAT(fault_of(AnimationFormat::kCsv, "t_ms;jawOpen\n0;0,2,5\n"),
              HasSubstr("not a number"));
}

std::string utf16(const std::string& ascii, bool big) {
  std::string bytes;
  for (const char c : ascii) {
    bytes += big ? std::string(1, '\0') + c : c + std::string(1, '\0');
  }
  return bytes;
}

TEST(Encodings, Utf16IsReadLikeUtf8) {
  const std::string text = "{\"t_ns\":1}\n{\"t_ns\":2}\n";
  for (const bool big : {false, true}) {
    EXPECT_EQ(read(AnimationFormat::kJsonl, utf16(text, big)).frames.unpacked().at(1).time_ns, 2);
    const std::string mark = big ? "\xFE\xFF" : "\xFF\xFE";
    EXPECT_EQ(
        read(AnimationFormat::kJsonl, mark + utf16(text, big)).frames.unpacked().at(1).time_ns, 2);
    EXPECT_THAT(fault_of(AnimationFormat::kJsonl, mark + utf16(text, big) + "x"),
                HasSubstr("truncated UTF-16 character"));
  }
}

TEST(Encodings, Utf16CoversAllOfUnicode) {
  const auto cues = [](const std::string& sound) {
    return R"({"metadata":{"soundFile":")" + sound +
           R"("},"mouthCues":[{"start":0,"end":1,"value":"A"}]})";
  };
  std::string bytes = "\xFF\xFE" + utf16(cues("x"), false);
  const std::size_t at =
      bytes.find(std::string("x\0", 2), bytes.find(std::string("l\0e\0\"\0:", 7)));
  const std::string smile = std::string("\xE9\0\x3D\xD8\x00\xDE", 6);  // é and U+1F600
  bytes.replace(at, 2, smile);
  EXPECT_EQ(read(AnimationFormat::kRhubarbJson, bytes).audio_file, "\xC3\xA9\xF0\x9F\x98\x80");
  bytes.replace(at, 6, std::string("\x00\xDE", 2));
  EXPECT_THAT(fault_of(AnimationFormat::kRhubarbJson, bytes), HasSubstr("surrogate"));
}

std::string motion(const std::string& neck, const std::string& tip, const std::string& position) {
  return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
         "JOINT Head\n{\nOFFSET 0 " +
         neck + " 0\nCHANNELS 3 Yrotation Xrotation Zrotation\nEnd Site\n{\nOFFSET 0 " + tip +
         " 0\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.04\n" + position + " 0 0 0\n";
}

TEST(BvhUnits, TheSizeOfTheSkeletonDeterminesThem) {
  const struct {
    const char *neck, *tip, *position;
    double place_m;
    const char* unit;
  } files[] = {
      {"0.6", "0.1", "2 0 0", 2.0, "positions: metres, detected from the size"},
      {"62.5", "15", "200 0 0", 2.0, "positions: centimetres, detected from the size"},
      {"600", "150", "2000 0 0", 2.0, "positions: millimetres, detected from the size"},
      {"0", "15", "200 0 0", 2.0, "positions: centimetres, detected from the size"},
      {"0", "0", "2 0 0", 2.0, "positions: metres, default (--from-bvh-unit)"},
  };
  for (const auto& file : files) {
    const Clip clip = read(AnimationFormat::kBvh, motion(file.neck, file.tip, file.position));
    EXPECT_NEAR((*clip.frames.unpacked().at(0).position_m)[0], file.place_m, 1e-12) << file.neck;
    EXPECT_THAT(clip.notes, ElementsAre(HasSubstr(file.unit)));
  }
  ReadOptions options;
  options.bvh_unit = LengthUnit::kInches;
  const Clip clip = read(AnimationFormat::kBvh, motion("24", "6", "100 0 0"), options);
  EXPECT_NEAR((*clip.frames.unpacked().at(0).position_m)[0], 2.54, 1e-12);
  EXPECT_THAT(clip.notes, IsEmpty());
}

TEST(BvhUnits, AreWrittenAsRequested) {
  Frame frame;
  frame.position_m = {0.5, 0.25, -1.5};
  frame.head = Angles();
  for (const LengthUnit unit : {LengthUnit::kMetres, LengthUnit::kCentimetres,
                                LengthUnit::kMillimetres, LengthUnit::kInches}) {
    WriteOptions options;
    options.bvh_unit = unit;
    const auto writer = animation_writer(AnimationFormat::kBvh, options);
    std::string text = writer->begin() + writer->frame(frame);
    text += writer->finish();
    EXPECT_THAT(text, HasSubstr(unit == LengthUnit::kCentimetres ? "\n50.000000 25.000000" : "\n"));
    ReadOptions reading;
    if (unit == LengthUnit::kInches) {
      reading.bvh_unit = unit;
    }
    const Clip clip = read(AnimationFormat::kBvh, text, reading);
    EXPECT_NEAR((*clip.frames.unpacked().at(0).position_m)[2], -1.5, 1e-6) << name(unit);
  }
}

TEST(MouthCues, TheMouthRestsInAGap) {
  const std::string json =
      R"({"mouthCues":[{"start":0,"end":0.2,"value":"D"},)"
      R"({"start":1,"end":1.4,"value":"C"},{"start":1.4,"end":2,"value":"B"}]})";
  const std::string xml =
      "<rhubarbResult><mouthCues><mouthCue start=\"0\" end=\"0.2\">D</mouthCue><mouthCue "
      "start=\"1\" "
      "end=\"1.4\">C</mouthCue><mouthCue start=\"1.4\" end=\"2\">B</mouthCue></mouthCues>"
      "</rhubarbResult>";
  for (const auto& [format, text] : {std::pair(AnimationFormat::kRhubarbJson, json),
                                     std::pair(AnimationFormat::kRhubarbXml, xml)}) {
    const Clip clip = read(format, text);
    EXPECT_THAT(times_ms(clip), ElementsAre(0.0, 200.0, 1000.0, 1400.0, 2000.0));
    std::string shapes;
    for (const Frame& frame : clip.frames) {
      shapes += frame.mouth_shape;
    }
    EXPECT_EQ(shapes, "DXCBX");
    EXPECT_EQ(clip.frames.unpacked().at(1).controls[formats::control("jawOpen")], 0.0);
    EXPECT_EQ(clip.frames.unpacked().at(1).number, 1);
    EXPECT_GT(clip.frames.unpacked().at(2).controls[formats::control("jawOpen")], 0.1);
  }
}

}  // namespace
}  // namespace mien::animation
