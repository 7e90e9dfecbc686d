// Values of JSON documents.
#include "apps/animation/json.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "apps/animation/json_text.h"
#include "apps/animation/numbers.h"

namespace mien::animation {

JsonValue::Kind JsonValue::kind() const {
  switch (document_->text_[document_->nodes_[node_].begin]) {
    case '{':
      return Kind::kObject;
    case '[':
      return Kind::kArray;
    case '"':
      return Kind::kString;
    case 't':
    case 'f':
      return Kind::kBoolean;
    case 'n':
      return Kind::kNull;
    default:
      return Kind::kNumber;
  }
}

// The text from the first byte of the value on; for a number or a string, up to its last byte.
std::string_view JsonValue::raw() const {
  const std::string_view rest = document_->text_.substr(document_->nodes_[node_].begin);
  return is(Kind::kString)   ? rest.substr(0, json_string_bytes(rest))
         : is(Kind::kNumber) ? rest.substr(0, rest.find_first_not_of("0123456789+-.eE"))
                             : rest;
}

bool JsonValue::truth() const { return raw().starts_with('t'); }

double JsonValue::number() const {
  double value = 0.0;
  return is(Kind::kNumber) && parse_number(raw(), value) ? value : 0.0;
}

bool JsonValue::integer(std::int64_t& value) const {
  return is(Kind::kNumber) && parse_number(raw(), value);
}

std::optional<std::string_view> JsonValue::plain_text() const {
  if (!is(Kind::kString)) {
    return std::nullopt;
  }
  const std::string_view inside = json_inside(raw());
  return inside.find('\\') == inside.npos ? std::optional(inside) : std::nullopt;
}

std::string JsonValue::text() const {
  return is(Kind::kString) ? json_unescaped(json_inside(raw())) : std::string();
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!is(Kind::kObject)) {
    return std::nullopt;
  }
  const Items members = items();
  for (auto at = members.begin(); at != members.end(); ++at) {
    const std::optional<std::string_view> plain = at.key().plain_text();
    if (plain ? *plain == key : at.key().text() == key) {
      return *at;
    }
  }
  return std::nullopt;
}

JsonValue::Items JsonValue::items() const {
  const std::uint32_t end = document_->nodes_[node_].end;
  return {*document_, node_ + 1, end, is(Kind::kObject)};
}

bool JsonValue::empty() const { return document_->nodes_[node_].end == node_ + 1; }

bool JsonValue::fail_here(std::string what, Fault& fault) const {
  return document_->fail_at(document_->nodes_[node_].begin, std::move(what), fault);
}

JsonValue::Items::Iterator& JsonValue::Items::Iterator::operator++() {
  node_ = document_->nodes_[value()].end;
  return *this;
}

bool JsonDocument::fail_at(std::size_t begin, std::string what, Fault& fault) const {
  const std::string_view before = text_.substr(0, begin);
  const std::size_t line_end = before.rfind('\n');
  const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  return fail(fault, first_line_ + lines, line_end == before.npos ? begin + 1 : begin - line_end,
              std::move(what));
}

std::string json_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      constexpr std::string_view kHex = "0123456789abcdef";
      quoted.append("\\u00").append(1, kHex[static_cast<unsigned char>(c) >> 4]);
      quoted += kHex[static_cast<unsigned char>(c) & 15];
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

}  // namespace mien::animation
