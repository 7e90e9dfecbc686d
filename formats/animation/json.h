// JSON (RFC 8259) as a tree that knows where each value stands, so that a reader can say not only
// that something is wrong but where. Duplicate keys are a fault.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/animation/fault.h"

namespace mien::formats {

struct JsonValue {
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  bool truth = false;
  double number = 0.0;
  std::string text;               // of a string what it says, of a number its digits
  std::vector<JsonValue> items;   // of an array, and the values of an object
  std::vector<std::string> keys;  // of an object, one for each of the items
  std::size_t line = 0;
  std::size_t column = 0;

  // The member of an object; nullptr where there is none, and of what is no object.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] bool is(Kind wanted) const { return kind == wanted; }

  // A whole number of 64 bits, exactly.
  [[nodiscard]] bool integer(std::int64_t& value) const;

  [[nodiscard]] bool fail_here(std::string what, Fault& fault) const {
    return fail(fault, line, column, std::move(what));
  }
};

// One value and nothing but blanks around it. `first_line` is the line that the text begins with.
[[nodiscard]] bool parse_json(std::string_view text, JsonValue& value, Fault& fault,
                              std::size_t first_line = 1);

// The text as a JSON string, in its quotation marks.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace mien::formats
