// A parser for simple XML documents, tag by tag: elements, attributes and text in UTF-8, without
// document types and with XML's own entities only. Only one tag is in memory, with its line and
// column: pugixml would keep the whole document, and expat would expand entities.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/animation/fault.h"

namespace mien::animation {

struct XmlTag {
  std::string name;
  bool closes = false;  // </name>
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  // up to the next tag, without surrounding blanks
  std::size_t line = 0;
  std::size_t column = 0;

  // nullptr if there is no such attribute. Valid as long as the tag.
  [[nodiscard]] const std::string* find(std::string_view attribute) const;

  [[nodiscard]] bool fail_here(std::string what, Fault& fault) const {
    return fail(fault, line, column, std::move(what));
  }
};

// Returns false to stop reading.
using XmlVisit = std::function<bool(const XmlTag& tag)>;

// Visits each tag when its text is complete, so that only one tag is in memory. Returns false with
// a fault for invalid documents: elements must be closed in order, and only whitespace may be
// outside the root. An empty element gives two tags. More than 64 nested elements, or 64 attributes
// per element, are an error.
[[nodiscard]] bool parse_xml(std::string_view text, const XmlVisit& visit, Fault& fault);

// Escapes text for XML.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace mien::animation
