// Tests of every error message of the animation readers, and of files by other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/base64.h"
#include "apps/animation/json.h"
#include "apps/animation/xml.h"

namespace mien::formats {
namespace {

using testing::HasSubstr;

// The error message for a file; empty if it was read.
std::string error_of(AnimationFormat format, const std::string& text, Clip* clip = nullptr) {
  Clip read;
  Fault fault;
  const bool good = read_animation(format, text, {}, read, fault);
  EXPECT_EQ(good, fault.what.empty());
  EXPECT_TRUE(good || read.frames.empty()) << "the clip stays unchanged";
  if (clip != nullptr) {
    *clip = read;
  }
  return fault.what;
}

struct InvalidFile {
  std::string text;
  std::string error;
};

void expect_errors(AnimationFormat format, const std::vector<InvalidFile>& files) {
  for (const InvalidFile& file : files) {
    EXPECT_THAT(error_of(format, file.text), HasSubstr(file.error)) << file.text;
  }
}

// A change of a valid file.
struct Change {
  std::string from;
  std::string to;
  std::string error;  // empty: the file stays valid
};

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expect_changes(AnimationFormat format, const std::string& good,
                    const std::vector<Change>& changes) {
  EXPECT_EQ(error_of(format, good), "");
  for (const Change& change : changes) {
    const std::string error = error_of(format, changed(good, change.from, change.to));
    if (change.error.empty()) {
      EXPECT_EQ(error, "") << change.from << " -> " << change.to;
    } else {
      EXPECT_THAT(error, HasSubstr(change.error)) << change.from << " -> " << change.to;
    }
  }
}

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

// A face with two blend shapes and a head, at 0 and 1 s.
std::vector<float> gltf_numbers() {
  return {0, 1, 0.5f, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0.6f, 0, 0.8f};
}

std::string gltf_of(const std::vector<float>& numbers) {
  std::string bytes;
  for (const float number : numbers) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    for (int i = 0; i < 4; ++i) {
      bytes += static_cast<char>(bits >> (8 * i));
    }
  }
  return R"({"asset":{"version":"2.0"},"nodes":[{"name":"face","mesh":0},{"name":"the_Head"},{"name":"leftEye"}],)"
         R"("meshes":[{"extras":{"targetNames":["jawOpen","mouthSmile_L"]}}],)"
         R"("animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}},)"
         R"({"sampler":1,"target":{"node":1,"path":"rotation"}}],)"
         R"("samplers":[{"input":0,"output":1},{"input":0,"output":2}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":2},)"
         R"({"bufferView":1,"componentType":5126,"count":4},{"bufferView":2,"componentType":5126,"count":2}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":16},)"
         R"({"buffer":0,"byteOffset":24,"byteLength":32}],)"
         R"("buffers":[{"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + R"("}]})";
}

TEST(AnimationFaults, Gltf) {
  const std::string no_such = "invalid index", range = "out of range";
  const std::string fits = "exceeds its buffer";
  expect_changes(
      AnimationFormat::kGltf, gltf_of(gltf_numbers()),
      {{"{\"asset", "[{\"asset", "',' or ']'"},
       {"\"animations\"", "\"nothing\"", "no animation"},
       {"\"animations\":[", "\"animations\":[],\"other\":[", "no animation"},
       {"\"animations\":[", "\"animations\":{},\"other\":[", "no animation"},
       {"\"uri\"", "\"url\"", "the buffer has no data in this file"},
       {"\"data:", "\"file:", "no folder to search"},
       {";base64,", ";base32,", "uri: invalid base64"},
       {";base64,", ";base64,?", "uri: invalid base64"},
       {"\"bufferView\":0", "\"bufferView\":9", no_such},
       {"\"bufferView\":0", "\"bufferView\":-1", no_such},
       {"\"bufferView\":0,", "", "bufferView: missing"},
       {"\"bufferView\":0", "\"bufferView\":0.5", "bufferView: missing"},
       {"\"bufferViews\"", "\"views\"", no_such},
       {"\"buffer\":0", "\"buffer\":1", no_such},
       {"\"componentType\":5126", "\"componentType\":5123", "integers must be normalized"},
       {"\"componentType\":5126", "\"componentType\":5125", "expected 5126 (float)"},
       {"\"componentType\":5126", "\"componentType\":\"x\"", "expected 5126 (float)"},
       {"{\"buffer\":0,", "{\"extensions\":{\"EXT_meshopt_compression\":{}},\"buffer\":0,",
        "compressed with EXT_meshopt_compression"},
       {"\"count\":2", "\"count\":-2", range},
       {"\"count\":2", "\"count\":5000000000", range},
       {"\"count\":2", "\"count\":2,\"byteOffset\":-4", range},
       {"\"count\":2", "\"count\":2,\"byteOffset\":4", fits},
       {"\"count\":2", "\"count\":2,\"sparse\":{}", "sparse accessors are not supported"},
       {"\"count\":2", "\"count\":0", "does not match the number of times"},
       {"\"count\":4", "\"count\":3", "does not match the number of times"},
       {"\"count\":4", "\"count\":40", fits},
       {"\"byteOffset\":8", "\"byteOffset\":-8", range},
       {"\"byteLength\":8", "\"byteLength\":-8", range},
       {"\"byteLength\":16", "\"byteLength\":1600", fits},
       {"\"byteLength\":8", "\"byteLength\":8,\"byteStride\":-4", range},
       {"\"byteLength\":8", "\"byteLength\":8,\"byteStride\":2", fits},
       {"\"byteLength\":8", "\"byteLength\":8,\"byteStride\":4", ""},
       {"\"input\":0", "\"input\":7", no_such},
       {"\"output\":1", "\"output\":7", no_such},
       {"\"output\":1", "\"output\":1,\"interpolation\":\"STEP\"", ""},
       {"\"output\":1", "\"output\":1,\"interpolation\":\"CUBICSPLINE\"", "does not match"},
       {"\"channels\"", "\"canals\"", "no channels or samplers"},
       {"\"samplers\"", "\"samples\"", "no channels or samplers"},
       {"\"sampler\":0", "\"sampler\":-1", "no sampler or target"},
       {"\"sampler\":0", "\"sampler\":2", "no sampler or target"},
       {"\"sampler\":0", "\"sampler\":null", "no sampler or target"},
       {"\"sampler\":0,", "", "no sampler or target"},
       {"\"target\"", "\"aim\"", "no sampler or target"},
       {"\"node\":0", "\"node\":3", no_such},
       {"\"node\":0,", "", ""},
       {"\"path\":\"weights\"", "\"way\":\"weights\"", ""},
       {"\"node\":1", "\"node\":2", ""},
       {"\"name\":\"the_Head\"", "\"name\":\"eye\"", ""},
       {"\"name\":\"the_Head\"", "\"title\":\"head\"", ""},
       {"\"path\":\"rotation\"", "\"path\":\"scale\"", ""},
       {"\"mesh\":0", "\"mesh\":1", no_such},
       {"\"extras\"", "\"more\"", "extras.targetNames: missing"},
       {"\"targetNames\":[", "\"targetNames\":[],\"x\":[", "extras.targetNames: missing"},
       {"\"jawOpen\",\"mouthSmile_L\"", "\"a\",\"b\"", ""},
       {"\"samplers\"", "\"extras\":{},\"samplers\"", ""},
       {"\"samplers\"", "\"extras\":{\"mien\":{\"start_ns\":\"x\"}},\"samplers\"",
        "start_ns: expected an integer"},
       {"\"samplers\"", "\"extras\":{\"mien\":{\"start_ns\":9000000000000000000}},\"samplers\"",
        "start_ns: out of range"},
       {"\"samplers\"",
        "\"extras\":{\"mien\":{\"start_ns\":5,\"states\":\"sl\",\"not_driven\":[\"jawOpen\","
        "\"nobody\"]}},\"samplers\"",
        ""}});
}

TEST(AnimationFaults, GltfWithOtherNumbers) {
  const auto with = [](std::size_t which, float number) {
    std::vector<float> numbers = gltf_numbers();
    numbers[which] = number;
    return gltf_of(numbers);
  };
  expect_errors(AnimationFormat::kGltf,
                {{with(1, -1), "times must increase"},
                 {with(1, 0), "times must increase"},
                 {with(1, 5e9f), "times must increase"},
                 {with(0, -5e9f), "times must increase"},
                 {with(3, std::numeric_limits<float>::infinity()), "is not a finite number"}});
  EXPECT_EQ(error_of(AnimationFormat::kGltf, with(9, 0.0f)), "");
  // Neither weights nor a head.
  const std::string eyes = changed(
      changed(gltf_of(gltf_numbers()), "\"path\":\"weights\"", "\"path\":\"x\""), "the_Head", "x");
  EXPECT_THAT(error_of(AnimationFormat::kGltf, eyes),
              HasSubstr("neither face weights nor a head are animated"));
  // A head with translation only.
  Clip clip;
  const std::string moves =
      changed(changed(gltf_of(gltf_numbers()), "\"path\":\"weights\"", "\"path\":\"x\""),
              "\"path\":\"rotation\"", "\"path\":\"translation\"");
  EXPECT_EQ(error_of(AnimationFormat::kGltf,
                     changed(moves, "2,\"componentType\":5126,\"count\":2",
                             "2,\"componentType\":5126,\"count\":2"),
                     &clip),
            "");
  ASSERT_EQ(clip.frames.size(), 2u);
  EXPECT_TRUE(clip.frames.unpacked()[1].position_m);
  EXPECT_FALSE(clip.frames.unpacked()[1].head);
}

TEST(AnimationFaults, Glb) {
  const auto word = [](std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) {
      bytes += static_cast<char>(value >> (8 * i));
    }
    return bytes;
  };
  const std::string json = "{}  ";
  const auto file = [&](std::uint32_t version, std::uint32_t more, std::uint32_t kind,
                        std::uint32_t size, const std::string& rest) {
    const std::string body = word(size) + word(kind) + json + rest;
    return "glTF" + word(version) + word(static_cast<std::uint32_t>(12 + body.size()) + more) +
           body;
  };
  constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;
  expect_errors(AnimationFormat::kGlb,
                {{"glTF", "the file ends within its header"},
                 {file(1, 0, kJson, 4, ""), "expected glTF version 2"},
                 {file(2, 1, kJson, 4, ""), "wrong file length"},
                 {file(2, 0, kBin, 4, ""), "the first chunk is not JSON"},
                 {file(2, 0, kJson, 5, ""), "the chunk exceeds the file"},
                 {file(2, 0, kJson, 4, word(9) + word(kBin)), "the chunk exceeds the file"},
                 {file(2, 0, kJson, 4, word(0) + word(kBin)), "no animation"},
                 {file(2, 0, kJson, 4, word(0) + word(7)), "no animation"},
                 {file(2, 0, kJson, 4, ""), "no animation"}});
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

std::string attributes(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += "a" + std::to_string(i) + "='' ";
  }
  return all;
}

TEST(AnimationFaults, Xml) {
  std::vector<XmlTag> tags;
  const auto keep = [&tags](const XmlTag& tag) {
    tags.push_back(tag);
    return true;
  };
  Fault fault;
  ASSERT_TRUE(
      parse_xml("<?xml?><!-- x --><a-b_c.d:e9 A=\"&lt;&gt;\" Z = '&quot;&apos;'>\n x &amp; y <b/> "
                "</a-b_c.d:e9>\n<!---->",
                keep, fault))
      << fault.what;
  EXPECT_EQ(*tags[0].find("A"), "<>");
  EXPECT_EQ(*tags[0].find("Z"), "\"'");
  EXPECT_EQ(tags[0].find("a"), nullptr);
  EXPECT_EQ(tags[0].text, "x & y");
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {"", "no element"},
           {"x", "expected a tag"},
           {"<?xml", "expected ?>"},
           {"<!-- x", "expected -->"},
           {"< >", "expected a tag name"},
           {"<a></a><b></b>", "second root element"},
           {"</a>", "unexpected closing tag </a>"},
           {"<a></b>", "unexpected closing tag </b>"},
           {"<a></a x>", "expected '>'"},
           {"<a>", "<a> is not closed"},
           {"<a", "an attribute or '>'"},
           {"<a \"b\">", "an attribute or '>'"},
           {"<a b>", "expected '='"},
           {"<a b=c>", "expected a quotation mark"},
           {"<a b='1' b='2'>", "duplicate attribute"},
           {"<a b='1>", "unterminated attribute value"},
           {"<a b='&x;'>", "unknown entity"},
           {"<a>&x;</a>", "unknown entity"},
           {"<a></a>b", "text outside the root element"},
           {repeated("<a>", 65), "too deeply nested"},
           {"<a " + attributes(65) + "/>", "more than 64 attributes"}}) {
    EXPECT_FALSE(parse_xml(text, keep, fault)) << text;
    EXPECT_THAT(fault.what, HasSubstr(error)) << text;
  }
  EXPECT_EQ(xml_text("a<&>\"'b"), "a&lt;&amp;&gt;&quot;&apos;b");
}

TEST(AnimationFaults, Rhubarb) {
  const std::string time = "expected a time in seconds", none = "no cues", back = "decreasing time",
                    shape = "unknown mouth shape";
  const auto cue = [](const std::string& what) { return "{\"mouthCues\":[{" + what + "}]}"; };
  expect_errors(
      AnimationFormat::kRhubarbJson,
      {{"{", "expected a key in quotation marks"},
       {"{}", none},
       {"{\"mouthCues\":[]}", none},
       {"{\"mouthCues\":1}", none},
       {cue(""), "start: " + time},
       {cue("\"start\":\"x\""), "start: " + time},
       {cue("\"start\":-1"), "start: " + time},
       {cue("\"start\":1e10"), "start: " + time},
       {cue("\"start\":1"), "end: " + time},
       {cue("\"start\":1,\"end\":0"), back},
       {cue("\"start\":0,\"end\":1"), shape},
       {cue("\"start\":0,\"end\":1,\"value\":\"Z\""), shape},
       {cue("\"start\":0,\"end\":1,\"value\":\"A\"},{\"start\":0,\"end\":1,\"value\":\"A\""),
        back}});
  const auto tag = [](const std::string& attributes, const std::string& text) {
    return "<rhubarbResult><mouthCue " + attributes + ">" + text + "</mouthCue></rhubarbResult>";
  };
  expect_errors(AnimationFormat::kRhubarbXml, {{"<a", "an attribute or '>'"},
                                               {"<a/>", "expected rhubarbResult"},
                                               {"<rhubarbResult/>", none},
                                               {tag("", "A"), "start: " + time},
                                               {tag("start='x'", "A"), "start: " + time},
                                               {tag("start='-1'", "A"), "start: " + time},
                                               {tag("start='1e10'", "A"), "start: " + time},
                                               {tag("start='1'", "A"), "end: " + time},
                                               {tag("start='1' end='0'", "A"), back},
                                               {tag("start='0' end='1'", "Z"), shape}});
  expect_errors(AnimationFormat::kRhubarb, {{"0\tA\n", none},
                                            {"x\tA\n", "is not a time"},
                                            {"-1\tA\n", "is not a time"},
                                            {"1e10\tA\n", "is not a time"},
                                            {"0\n", shape},
                                            {"0\tZ\n", shape},
                                            {"1\tA\n0\tX\n", back}});
  EXPECT_EQ(error_of(AnimationFormat::kRhubarb, "0\tA\r\n\n1\tX"), "");
  const std::string dat = "MohoSwitch1\n";
  expect_errors(AnimationFormat::kRhubarbDat, {{dat, none},
                                               {dat + "x A", "is not a frame"},
                                               {dat + "0 A", "is not a frame"},
                                               {dat + "999999999999 A", "is not a frame"},
                                               {dat + "1 Z", "unknown mouth shape"},
                                               {dat + "1", "unknown mouth shape"},
                                               {dat + "2 A\n2 X", back},
                                               {dat + "1 MBP\n2 A", "unknown mouth shape"},
                                               {dat + "1 A\n2 rest", "unknown mouth shape"}});
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kRhubarbDat, dat + "1 E\r\n\n3 MBP\n9 rest\n", &clip), "");
  EXPECT_EQ(clip.frames.unpacked().at(0).mouth_shape, 'C') << "Preston Blair's E";
  EXPECT_EQ(error_of(AnimationFormat::kRhubarbDat, dat + "1 E\n3 A\n9 X\n", &clip), "");
  EXPECT_EQ(clip.frames.unpacked().at(0).mouth_shape, 'E');
}

TEST(AnimationFaults, RhubarbUsesShapesOrVisemes) {
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kRhubarb, "0\tA\n0.5\tD\n1\tX\n", &clip), "");
  clip.audio_file = "a & \"b\"";
  for (const AnimationFormat format :
       {AnimationFormat::kRhubarb, AnimationFormat::kRhubarbJson, AnimationFormat::kRhubarbXml,
        AnimationFormat::kRhubarbDat}) {
    WriteOptions options;
    options.audio_file = clip.audio_file;
    for (const bool as_read : {true, false}) {
      std::vector<Frame> frames = clip.frames.unpacked();
      if (!as_read) {
        frames[1].mouth_shape = 0;  // so all shapes are recomputed
        frames[1].visemes.assign(15, 0.0);
        frames[1].visemes[0] = 1.0;
        frames[0].time_ns += 10'000'000;
        frames[2].time_ns += 10'000'000;
      }
      const auto writer = animation_writer(format, options);
      std::string text = writer->begin();
      for (const Frame& frame : frames) {
        text += writer->frame(frame);
      }
      text += writer->finish();
      Clip back;
      EXPECT_EQ(error_of(format, text, &back), "") << text;
      EXPECT_EQ(back.frames.unpacked().at(0).mouth_shape, as_read ? 'A' : 'X') << text;
    }
    const auto empty = animation_writer(format, options);
    EXPECT_THAT(error_of(format, empty->begin() + empty->finish()), HasSubstr("no cues"));
  }
}

TEST(AnimationFaults, Bvh) {
  const std::string good =
      "HIERARCHY\nROOT Hips {\nOFFSET 1 2 3\nCHANNELS 3 Xposition Yposition Zposition\nJOINT "
      "TheHead {\nOFFSET 0 1 0\n"
      "CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site {\nOFFSET 0 0 "
      "0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n0 0 0 90 0 0\n1 2 3 0 0 90\n";
  expect_changes(AnimationFormat::kBvh, good,
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
  std::string deep = "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 0";
  for (int i = 0; i < 200; ++i) {
    deep += " JOINT b { OFFSET 0 0 0 CHANNELS 0";
  }
  expect_errors(AnimationFormat::kBvh,
                {{deep, "too deeply nested"},
                 {"HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 0 }", "no joint has a channel"},
                 {"HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 1", "unknown channel"}});
  Clip clip;
  EXPECT_EQ(error_of(AnimationFormat::kBvh, good, &clip), "");
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
  const std::string share = "0..1";
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
}  // namespace mien::formats
