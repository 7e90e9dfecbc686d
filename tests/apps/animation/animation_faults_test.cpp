// Tests of every error message of the animation readers, and of files by other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/json.h"
#include "tests/apps/animation/animation_faults.h"

namespace mien::animation {
namespace {

using testing::HasSubstr;

TEST(AnimationFaults, Jsonl) {
  const auto with = [](const std::string& member) { return "{\"t_ns\":0," + member + "}\n"; };
  expect_errors(AnimationFormat::kJsonl,
                {{"", "no frames"},
                 {"[1]", "expected an object"},
                 {"{\"frame\":1}", "t_ns: missing"},
                 {"{\"t_ns\":\"0\"}", "t_ns: expected an integer"},
                 {"{\"t_ns\":5}\n{\"t_ns\":4}", "t_ns: decreasing time"},
                 {with("\"frame\":1.5"), "frame: expected an integer"},
                 {with("\"face_id\":\"a\""), "face_id: expected an integer"},
                 {with("\"lod\":0.5"), "lod: expected an integer"},
                 {with("\"status\":\"gone\""), "status: expected"},
                 {with("\"status\":1"), "status: expected"},
                 {with("\"face_prob\":2"), "face_prob: expected a number in 0..1"},
                 {with("\"face_prob\":-1"), "face_prob: expected a number in 0..1"},
                 {with("\"vad\":\"x\""), "vad: expected a number in 0..1"},
                 {with("\"box\":[1,2,3]"), "box: expected 4 numbers"},
                 {with("\"box\":[1,2,3,null]"), "box: expected 4 numbers"},
                 {with("\"box\":1"), "box: expected 4 numbers"},
                 {with("\"head\":{}"), "pitch_rad, yaw_rad and roll_rad are required"},
                 {with("\"head\":{\"pitch_rad\":true}"), "pitch_rad, yaw_rad and roll_rad"},
                 {with("\"position_m\":[1]"), "position_m: expected 3 numbers"},
                 {with("\"eyes\":{}"), "eyes: left and right are required"},
                 {with("\"eyes\":{\"left\":{\"pitch_rad\":0,\"yaw_rad\":0,\"roll_rad\":0}}"),
                  "eyes: left and right are required"},
                 {with("\"eyes\":{\"left\":{}}"), "pitch_rad, yaw_rad and roll_rad"},
                 {with("\"eyes\":{\"right\":{}}"), "pitch_rad, yaw_rad and roll_rad"},
                 {with("\"controls\":[]"), "controls: expected an object"},
                 {with("\"controls\":{\"nobody\":1}"), "controls: unknown name 'nobody'"},
                 {with("\"controls\":{\"jawOpen\":2}"), "jawOpen: expected a number in 0..1"},
                 {with("\"facs\":{\"JawDrop\":null}"), "JawDrop: expected a number in 0..1"},
                 {with("\"visemes\":3"), "visemes: expected an object"},
                 {with("\"mouth_shape\":\"Z\""), "mouth_shape: expected"},
                 {with("\"mouth_shape\":\"AB\""), "mouth_shape: expected"},
                 {with("\"mouth_shape\":1"), "mouth_shape: expected"}});
}

TEST(AnimationFaults, JsonlWithAllFields) {
  const std::string line =
      R"({"t_ns":7,"frame":3,"status":"lost","face_id":2,"face_prob":0.5,"lod":4,"vad":0.25,)"
      R"("box":[1,2,3,4],"head":{"pitch_rad":1,"yaw_rad":0,"roll_rad":0},"position_m":[1,2,3],)"
      R"("eyes":{"left":{"pitch_rad":0,"yaw_rad":1,"roll_rad":0},)"
      R"("right":{"pitch_rad":0,"yaw_rad":0,"roll_rad":1}},"controls":{"jawOpen":1},)"
      R"("facs":{"JawDrop":0.5},"visemes":{"sil":1},"mouth_shape":"B"})";
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kJsonl, " \r\n" + line + "\n\n", &clip), "");
  ASSERT_EQ(clip.frames.size(), 1u);
  const Frame frame = clip.frames.unpacked()[0];
  EXPECT_EQ(frame.state, FaceState::kLost);
  EXPECT_EQ((*frame.box)[3], 4.0);
  EXPECT_EQ((*frame.eyes)[1].roll, 1.0);
  EXPECT_EQ(frame.mouth_shape, 'B');
  const std::string written = animation_writer(AnimationFormat::kJsonl, {})->frame(frame);
  Clip again;
  EXPECT_EQ(error_of(AnimationFormat::kJsonl, written, &again), "");
  EXPECT_EQ(animation_writer(AnimationFormat::kJsonl, {})->frame(again.frames.unpacked().at(0)),
            written);
}

TEST(AnimationFaults, JsonStrings) {
  JsonDocument document;
  Fault fault;
  ASSERT_TRUE(
      document.parse(R"(["\u00e4\u20AC\ud83d\ude00\"\\\/\b\f\n\r\t",{},[],-0.5E+2])", fault));
  std::vector<JsonValue> items;
  for (const JsonValue item : document.root().items()) {
    items.push_back(item);
  }
  EXPECT_EQ(items.at(0).text(), "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80\"\\/\b\f\n\r\t");
  EXPECT_EQ(items.at(3).number(), -50.0);
  const std::string quoted = json_string("\x01\x1F \"\\ x");
  ASSERT_TRUE(document.parse(quoted, fault));
  EXPECT_EQ(document.root().text(), "\x01\x1F \"\\ x");
  for (const char* bad :
       {R"("\udc00")", R"("\ud800x")", R"("\ud800\n")", R"("\ud800\u0041")", R"("\ud800\ue000")",
        R"("\u00)", R"("\u00:0")", "\"\\", "\"\\q\"", "1e", "1.x", "[1", "[x]", "{\"a\"}", "{1:2}",
        "{\"a", "fals", "\"a\nb\"", "{\"a\":x}"}) {
    EXPECT_FALSE(document.parse(bad, fault)) << bad;
  }
  std::string deep(64, '[');
  EXPECT_TRUE(document.parse(deep + "1" + std::string(64, ']'), fault));
  for (const char* bracket : {"[", "{\"a\":"}) {
    EXPECT_FALSE(document.parse(deep + bracket, fault));
    EXPECT_EQ(fault.what, "too deeply nested");
  }
}

constexpr const char* kBvh =
    "HIERARCHY\nROOT Hips {\nOFFSET 1 2 3\nCHANNELS 3 Xposition Yposition Zposition\nJOINT "
    "TheHead {\nOFFSET 0 1 0\n"
    "CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site {\nOFFSET 0 0 "
    "0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n0 0 0 90 0 0\n1 2 3 0 0 90\n";

TEST(AnimationFaults, Bvh) {
  expect_changes(AnimationFormat::kBvh, kBvh,
                 {{"HIERARCHY", "HIGHARCHY", "expected 'HIERARCHY'"},
                  {"ROOT", "TOOT", "expected 'ROOT'"},
                  {"{", "(", "expected '{'"},
                  {"OFFSET", "ONSET", "expected 'OFFSET'"},
                  {"OFFSET 1", "OFFSET x", "is not a number"},
                  {"1 2 3", "1 x 3", "is not a number"},
                  {"1 2 3", "1 2 x", "is not a number"},
                  {"CHANNELS", "CANALS", "expected 'CHANNELS'"},
                  {"CHANNELS 3", "CHANNELS 7", "invalid number of channels"},
                  {"CHANNELS 3", "CHANNELS -1", "invalid number of channels"},
                  {"CHANNELS 3", "CHANNELS x", "invalid number of channels"},
                  {"Xposition", "Xpositiom", "unknown channel"},
                  {"Xposition", "Wposition", "unknown channel"},
                  {"Xposition", "Xpos", "unknown channel"},
                  {"JOINT", "POINT", "expected JOINT, End or '}'"},
                  {"End Site", "End Sight", "expected 'Site'"},
                  {"Site {", "Site (", "expected '{'"},
                  {"OFFSET 0 0 0", "ONSET 0 0 0", "expected 'OFFSET'"},
                  {"OFFSET 0 0 0", "OFFSET 0 0 x", "is not a number"},
                  {"OFFSET 0 0 0\n}", "OFFSET 0 0 0 ]", "expected '}'"},
                  {"OFFSET 0 1 0", "OFFSET x", "is not a number"},
                  {"MOTION", "NOTION", "expected 'MOTION'"},
                  {"Frames:", "Games:", "expected 'Frames:'"},
                  {"Frames: 2", "Frames: 0", "invalid number of frames"},
                  {"Frames: 2", "Frames: x", "invalid number of frames"},
                  {"Frames: 2", "Frames: 99999999999", "invalid number of frames"},
                  {"Frame Time", "Fame Time", "expected 'Frame'"},
                  {"Time:", "Dime:", "expected 'Time:'"},
                  {"0.5", "x", "is not a number"},
                  {"0.5", "0", "frame time out of range"},
                  {"0.5", "4000", "frame time out of range"},
                  {"Frames: 2", "Frames: 1", "more than 1 frames"},
                  {"Frames: 2", "Frames: 3", "is not a number"},
                  {"TheHead", "Neck", ""},
                  {"TheHead", "ead", ""}});
}

TEST(AnimationFaults, BvhWithOtherJoints) {
  std::string deep = "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 0";
  for (int i = 0; i < 200; ++i) {
    deep += " JOINT b { OFFSET 0 0 0 CHANNELS 0";
  }
  expect_errors(AnimationFormat::kBvh,
                {{deep, "too deeply nested"},
                 {"HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 0 }", "no joint has a channel"},
                 {"HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 1", "unknown channel"}});
}

TEST(AnimationFaults, BvhHeadMotion) {
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kBvh, kBvh, &clip), "");
  EXPECT_NEAR(clip.frames.unpacked().at(0).head->roll, 1.5707963, 1e-6);
  EXPECT_NEAR((*clip.frames.unpacked().at(1).position_m)[1], 5.0, 1e-9)
      << "2 + 2 of the hips, 1 of the head";
  // No joint moves, and the head is the root with another order of axes.
  const std::string still =
      "HIERARCHY ROOT head { OFFSET 0 0 0 CHANNELS 2 Xrotation Yrotation } MOTION Frames: 1 Frame "
      "Time: 1 0 90";
  EXPECT_EQ(error_of(AnimationFormat::kBvh, still, &clip), "");
  EXPECT_FALSE(clip.frames.unpacked().at(0).position_m);
  EXPECT_NEAR(clip.frames.unpacked().at(0).head->yaw, 1.5707963, 1e-6);
}

TEST(AnimationFaults, Csv) {
  const std::string good =
      "frame,face_id,t_ms,status,face_prob,lod,vad,x,y,w,h,pitch_rad,yaw_rad,roll_rad,tx_m,ty_m,tz_"
      "m,jawOpen\n"
      "1,2,10,lost,0.5,4,0.25,1,2,3,4,0.1,0.2,0.3,5,6,7,0.75\n";
  expect_changes(AnimationFormat::kCsv, good,
                 {{"t_ms", "t_us", "t_ms: missing column"},
                  {"jawOpen", "mawOpen", "no column with a control"},
                  {"1,2,10", "1,2,", "t_ms: empty"},
                  {"1,2,10", "1,2,x", "t_ms"},
                  {"1,2,10", "1,2,1e13", "out of range"},
                  {"1,2,10", "1.5,2,10", "frame: '1.5' is not an integer"},
                  {"1,2,10", "1,x,10", "face_id: 'x' is not an integer"},
                  {",4,0.25", ",0.4,0.25", "lod: '0.4' is not an integer"},
                  {"lost", "last", "is unknown, expected searching"},
                  {"0.5,", "5,", "face_prob"},
                  {"0.25", "25", "vad"},
                  {",1,2,3,4,", ",1,2,x,4,", "w"},
                  {"0.1,", "7,", "more than a full turn"},
                  {"0.1,", "x,", "pitch_rad"},
                  {",5,6,7,", ",5,6,x,", "tz_m"},
                  {"0.75", "x", "jawOpen"},
                  {",1,2,3,4,", ",1,2,,4,", ""},
                  {"0.1,", ",", ""},
                  {"0.75\n", "0.75,1\n", "cell"},
                  {"0.75\n", "0.75\n1,2,9,lost,0.5,4,0.25,1,2,3,4,0.1,0.2,0.3,5,6,7,0.75\n",
                   "t_ms: decreasing time"}});
  EXPECT_THAT(error_of(AnimationFormat::kCsv, good.substr(0, good.find('\n') + 1)),
              HasSubstr("no frames"));
  EXPECT_EQ(error_of(AnimationFormat::kRoblox, "t_ms,JawDrop\n1,0.5\n"), "");
  expect_errors(AnimationFormat::kVisemes, {{"t_ms,sil\n1,2\n", "sil"}});
  // All forms of the table, for one face and several.
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kCsv, good, &clip), "");
  for (const AnimationFormat format :
       {AnimationFormat::kCsv, AnimationFormat::kRoblox, AnimationFormat::kVisemes}) {
    WriteOptions options;
    options.several_faces = true;
    options.roblox_level_1 = true;
    const auto writer = animation_writer(format, options);
    const std::string text = writer->begin() + writer->frame(clip.frames.unpacked()[0]);
    Clip back;
    EXPECT_EQ(error_of(format, text, &back), "") << text;
    EXPECT_EQ(back.frames.unpacked().at(0).face_id, 2);
    EXPECT_EQ(back.frames.unpacked().at(0).lod, 4);
    const auto again = animation_writer(format, options);
    EXPECT_FALSE(again->frame(back.frames.unpacked()[0]).empty());
  }
}

TEST(AnimationFaults, LiveLink) {
  const std::string good =
      "Timecode,BlendshapeCount,JawOpen,HeadYaw,HeadPitch,HeadRoll\n00:00:01:30.500,61,0.5,0.1,0.2,"
      "0.3\n00:00:02;00,61,0.5,,0.2,0.3\n";
  const std::string form = "is not HH:MM:SS:FF.mmm";
  expect_changes(AnimationFormat::kLiveLink, good,
                 {{"Timecode", "Dimecode", "missing column Timecode"},
                  {"BlendshapeCount", "Blend", "missing column BlendshapeCount"},
                  {"JawOpen", "MawOpen", "no column with a blend shape"},
                  {"00:00:01:30.500", "00:00:01", form},
                  {"00:00:01:30.500", "00:00:x:30", form},
                  {"00:00:01:30.500", "00:00:-1:30", form},
                  {"00:00:01:30.500", "00:00:1.5:30", form},
                  {"00:00:01:30.500", "00:61:01:30", "is not a time of day"},
                  {"00:00:01:30.500", "00:00:60:30", "is not a time of day"},
                  {"00:00:01:30.500", "100:00:01:30", "is not a time of day"},
                  {"00:00:01:30.500", "00:00:01:60", "has more frames than a second of 60"},
                  {"00:00:02;00", "00:00:00:00", "Timecode: decreasing time"},
                  {",61,0.5,0.1", ",x,0.5,0.1", "BlendshapeCount: invalid count"},
                  {",61,0.5,0.1", ",-1,0.5,0.1", "BlendshapeCount: invalid count"},
                  {"0.5,0.1", "x,0.1", "JawOpen"},
                  {"0.5,0.1", "0.5,x", "HeadYaw"},
                  {"0.5,0.1,0.2", "0.5,0.1", "cell"},
                  {",61,0.5,0.1", ",0,0.5,0.1", ""},
                  {"00:00:01:30.500", "", ""},
                  {"00:00:01:30.500", "23:59:59:00", ""}});
  EXPECT_THAT(error_of(AnimationFormat::kLiveLink, good.substr(0, good.find('\n') + 1)),
              HasSubstr("no frames"));
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kLiveLink, good, &clip), "");
  for (const RotationUnit unit :
       {RotationUnit::kRadians, RotationUnit::kDegreesBy180, RotationUnit::kDegrees}) {
    WriteOptions options;
    options.live_link.rotation = unit;
    Frame frame = clip.frames.unpacked()[0];
    for (const std::int64_t time_ns :
         {std::int64_t{-1}, std::int64_t{999'999'999}, std::int64_t{90'000'000'000'000}}) {
      frame.time_ns = time_ns;
      const auto writer = animation_writer(AnimationFormat::kLiveLink, options);
      const std::string text = writer->begin() + writer->frame(frame) + writer->finish();
      Clip back;
      Fault fault;
      ReadOptions reading;
      reading.rotation = unit;
      ASSERT_TRUE(read_animation(AnimationFormat::kLiveLink, text, reading, back, fault)) << text;
      EXPECT_NEAR(back.frames.unpacked().at(0).head->yaw, frame.head->yaw, 1e-8);
    }
  }
}

// 2^62 ns is 146 years.
TEST(AnimationFaults, TimesOutOfRange) {
  const auto jsonl = [](const std::string& time) { return "{\"t_ns\":" + time + "}\n"; };
  for (const char* last : {"4611686018427387903", "-4611686018427387903"}) {
    EXPECT_EQ(error_of(AnimationFormat::kJsonl, jsonl(last)), "");
  }
  const std::string range = "out of range", seconds = "expected a time in seconds";
  for (const char* far : {"4611686018427387904", "-4611686018427387904", "9223372036854775807",
                          "-9223372036854775808"}) {
    expect_errors(AnimationFormat::kJsonl, {{jsonl(far), "t_ns: " + range}});
    expect_changes(AnimationFormat::kGltf, gltf_of(gltf_numbers()),
                   {{"\"samplers\"",
                     "\"extras\":{\"mien\":{\"start_ns\":" + std::string(far) + "}},\"samplers\"",
                     "start_ns: " + range}});
  }
  expect_changes(
      AnimationFormat::kGltf, gltf_of(gltf_numbers()),
      {{"\"samplers\"", "\"extras\":{\"mien\":{\"start_ns\":4611686018427387903}},\"samplers\"",
        "the times of frames are out of range"}});
  const auto csv = [](const std::string& time) { return "t_ms,jawOpen\n" + time + ",0\n"; };
  for (const char* far : {"4611686018428", "-4611686018428", "1e300", "-1e300"}) {
    expect_errors(AnimationFormat::kCsv,
                  {{csv(far), "t_ms: '" + std::string(far) + "' is " + range}});
  }
  for (const char* near : {"4611686018427", "-4611686018427", "1e12", "-1e12"}) {
    EXPECT_EQ(error_of(AnimationFormat::kCsv, csv(near)), "");
  }
  const auto cue = [](const std::string& end) {
    return R"({"mouthCues":[{"start":0,"end":)" + end + R"(,"value":"A"}]})";
  };
  EXPECT_EQ(error_of(AnimationFormat::kRhubarb, "0\tA\n4611686018.42\tX\n"), "");
  EXPECT_EQ(error_of(AnimationFormat::kRhubarbJson, cue("4611686018.42")), "");
  expect_errors(AnimationFormat::kRhubarb, {{"0\tA\n4611686018.43\tX\n", "is not a time"},
                                            {"-1\tA\n0\tX\n", "is not a time"}});
  expect_errors(
      AnimationFormat::kRhubarbJson,
      {{cue("4611686018.43"), seconds}, {cue("-0.01"), seconds}, {cue("1e300"), seconds}});
  EXPECT_EQ(error_of(AnimationFormat::kRhubarbDat, "MohoSwitch1\n1 A\n110680464443 X\n"), "");
  for (const char* far : {"110680464444", "9223372036854775807"}) {
    expect_errors(AnimationFormat::kRhubarbDat,
                  {{"MohoSwitch1\n1 A\n" + std::string(far) + " X\n", "is not a frame"}});
  }
}

// After midnight hours restart: here more often than times permit.
TEST(AnimationFaults, LiveLinkWithTooManyDays) {
  constexpr std::size_t kDays = 53377;
  std::string text = "Timecode,BlendshapeCount,JawOpen\n";
  for (std::size_t day = 0; day < kDays; ++day) {
    text += "00:00:00:00,0\n11:00:00:00,0\n22:00:00:00,0\n";
  }
  EXPECT_EQ(error_of(AnimationFormat::kLiveLink, text), "Timecode: out of range");
}

TEST(AnimationFaults, NamesOfFormats) {
  for (const FormatName& known : kFormatNames) {
    EXPECT_EQ(name(known.format), known.name);
  }
  EXPECT_EQ(format_named("nothing"), std::nullopt);
  EXPECT_TRUE(holds_several_faces(AnimationFormat::kVisemes));
  EXPECT_TRUE(holds_several_faces(AnimationFormat::kRoblox));
  EXPECT_TRUE(holds_several_faces(AnimationFormat::kJsonl));
  EXPECT_FALSE(holds_several_faces(AnimationFormat::kBvh));
  EXPECT_EQ(format_by_content("{\n\"mouthCues\":[]}"), AnimationFormat::kRhubarbJson);
  EXPECT_EQ(format_by_content("{\n\"asset\":{}}"), AnimationFormat::kGltf);
  EXPECT_EQ(format_by_content("{\n}"), AnimationFormat::kJsonl);
  EXPECT_EQ(format_by_content(" \n"), AnimationFormat::kCsv);
  EXPECT_EQ(format_by_content("a\tb,c"), AnimationFormat::kCsv);
  EXPECT_EQ(format_by_content("\"a"), AnimationFormat::kCsv)
      << "an unreadable table is still detected as one";
}

}  // namespace
}  // namespace mien::animation
