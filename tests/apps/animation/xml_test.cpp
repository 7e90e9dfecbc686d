// Tests of XML tags and the positions of errors.
#include "apps/animation/xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "apps/animation/fault.h"

namespace mien::animation {
namespace {

using testing::ElementsAre;

std::vector<XmlTag> xml_tags(const std::string& text) {
  std::vector<XmlTag> tags;
  Fault fault;
  const auto keep = [&tags](const XmlTag& tag) {
    tags.push_back(tag);
    return true;
  };
  EXPECT_TRUE(parse_xml(text, keep, fault)) << describe(fault);
  return tags;
}

std::string xml_fault(const std::string& text) {
  Fault fault;
  const auto keep = [](const XmlTag&) { return true; };
  return parse_xml(text, keep, fault) ? "none" : describe(fault);
}

std::string tags_repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) {
    all += text;
  }
  return all;
}

std::string numbered_attributes(std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) {
    all += " a" + std::string(i, 'a') + "='1'";
  }
  return all;
}

TEST(Xml, TagsHaveAPosition) {
  std::vector<std::string> places;
  for (const XmlTag& tag : xml_tags("<?xml?>\n <a>\n\n<b/>text\n  </a>\n")) {
    places.push_back((tag.closes ? "/" : "") + tag.name + " " + std::to_string(tag.line) + ":" +
                     std::to_string(tag.column));
  }
  EXPECT_THAT(places, ElementsAre("a 2:2", "b 4:1", "/b 4:1", "/a 5:3"));
}

TEST(Xml, AnEmptyElementIsTwoTags) {
  const std::vector<XmlTag> tags = xml_tags("<a><b c='1'/> x </a>");
  ASSERT_EQ(tags.size(), 4u);
  EXPECT_EQ(tags[1].attributes.size(), 1u);
  EXPECT_FALSE(tags[1].closes);
  EXPECT_TRUE(tags[2].closes);
  EXPECT_TRUE(tags[2].attributes.empty());
  EXPECT_EQ(tags[1].text, "");
  EXPECT_EQ(tags[2].text, "x");
}

TEST(Xml, NamesHaveLettersDigitsAndFourSigns) {
  for (const char c : std::string("azAZ09_-.:")) {
    EXPECT_EQ(xml_tags(std::string("<") + c + "/>")[0].name, std::string(1, c));
  }
  for (const char c : std::string("`{@[;/,^")) {
    EXPECT_NE(xml_fault(std::string("<a") + c + "></a" + c + ">"), "none") << c;
  }
}

TEST(Xml, TextIsTrimmedAndContinuesAfterAComment) {
  const std::vector<XmlTag> tags =
      xml_tags("<a>\t\r\n x  y \n<!-- <b> -->\tz&amp;&lt;&gt;&quot;&apos;</a>");
  ASSERT_EQ(tags.size(), 2u);
  EXPECT_EQ(tags[0].text, "x  yz&<>\"'");
}

TEST(Xml, AcceptsSixtyFourElementsAndAttributes) {
  EXPECT_EQ(xml_tags(tags_repeated("<a>", 64) + tags_repeated("</a>", 64)).size(), 128u);
  EXPECT_EQ(xml_fault(tags_repeated("<a>", 64) + "<b/>"), "line 1, column 193: too deeply nested");
  EXPECT_EQ(xml_tags("<a" + numbered_attributes(64) + "/>")[0].attributes.size(), 64u);
  EXPECT_EQ(xml_fault("<a" + numbered_attributes(65) + "/>").substr(0, 7), "line 1,");
}

TEST(Xml, ErrorsHaveAPosition) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"\n x", "line 2, column 2: expected a tag"},
      {"<a/>\n<?xml", "line 2, column 1: expected ?>"},
      {"<a>\n<!-- ->", "line 2, column 1: expected -->"},
      {"<a>\n<>", "line 2, column 2: expected a tag name"},
      {"<a/>\n <b/>", "line 2, column 2: second root element"},
      {"<a>\n\n</b>", "line 3, column 1: unexpected closing tag </b>"},
      {"<a>\n", "line 2, column 1: <a> is not closed"},
      {"<a></a\n x>", "line 2, column 2: expected '>'"},
      {"<a\n '1'>", "line 2, column 2: expected an attribute or '>'"},
      {"<a\n b c>", "line 2, column 4: expected '='"},
      {"<a b=\n1>", "line 2, column 1: expected a quotation mark"},
      {"<a b='1'\nb='2'>", "line 2, column 3: duplicate attribute 'b'"},
      {"<a b=\n 'x>", "line 2, column 2: unterminated attribute value"},
      {"<a b='\n&amp;&auml;'>", "line 2, column 6: unknown entity"},
      {"<a>\n &amp</a>", "line 2, column 2: unknown entity"},
      {"<a/>\n\n  x", "line 3, column 3: text outside the root element"}};
  for (const auto& [text, fault] : cases) {
    EXPECT_EQ(xml_fault(text), fault) << text;
  }
}

TEST(Xml, TheVisitorCanStopReading) {
  for (const std::size_t most : {1u, 2u, 3u}) {
    std::size_t visited = 0;
    Fault fault;
    const auto some = [&](const XmlTag&) { return ++visited < most; };
    EXPECT_FALSE(parse_xml("<a><b/></a>", some, fault));
    EXPECT_EQ(visited, most);
  }
}

}  // namespace
}  // namespace mien::animation
