// The tags of an XML document one by one, for readers of simple ones: elements, attributes and text
// in UTF-8, no document types, no entities but those of XML itself.
#pragma once

#include <cstddef>
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

// False, with a fault, for what is no such document: elements have to be closed in turn, and
// nothing but blanks stands outside the outermost. An empty element gives two tags.
[[nodiscard]] bool parse_xml(std::string_view text, std::vector<XmlTag>& tags, Fault& fault);

// The text as it stands in a document.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace mien::formats
