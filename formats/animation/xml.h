// The tags of an XML document one by one, for readers of simple ones: elements, attributes and text
// in UTF-8, no document types, no entities but those of XML itself.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/animation/fault.h"

namespace mien::formats {

struct XmlTag {
  std::string name;
  bool closes = false;  // </name>
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  // between it and the next tag, without blanks around it
  std::size_t line = 0;
  std::size_t column = 0;

  // Nothing where there is no such attribute. Valid as long as the tag.
  [[nodiscard]] const std::string* find(std::string_view attribute) const;

  [[nodiscard]] bool fail_here(std::string what, Fault& fault) const {
    return fail(fault, line, column, std::move(what));
  }
};

// What is done with a tag; false ends the reading.
using XmlVisit = std::function<bool(const XmlTag& tag)>;

// Visits each tag once its text is known, so that only one is in memory. False, with a fault, for
// what is no such document: elements have to be closed in turn, and nothing but blanks stands
// outside the outermost. An empty element gives two tags. More than 64 elements inside each other,
// or attributes of one, are a fault.
[[nodiscard]] bool parse_xml(std::string_view text, const XmlVisit& visit, Fault& fault);

// The text as it stands in a document.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace mien::formats
