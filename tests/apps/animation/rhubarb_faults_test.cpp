// Tests of every error message of the XML parser and of the readers of Rhubarb's cues.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/xml.h"
#include "tests/apps/animation/animation_faults.h"

namespace mien::animation {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace mien::animation
