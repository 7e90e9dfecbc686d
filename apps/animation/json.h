// A JSON parser (RFC 8259). Common JSON libraries neither report the line and column of a value nor
// bound their memory: here errors in the content have a position, and a value takes 8 bytes, with
// at least two bytes of text. Values refer to the text. Duplicate keys are an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "apps/animation/fault.h"

namespace mien::animation {

class JsonDocument;

// A value of a document, which must outlive it. Cheap to copy.
class JsonValue {
 public:
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

  [[nodiscard]] Kind kind() const;
  [[nodiscard]] bool is(Kind wanted) const { return kind() == wanted; }
  [[nodiscard]] bool truth() const;        // whether it is `true`
  [[nodiscard]] double number() const;     // 0 if it is not a number
  [[nodiscard]] std::string text() const;  // the content of a string; empty for other kinds
  // The same without a copy, if the string has no escapes.
  [[nodiscard]] std::optional<std::string_view> plain_text() const;
  // Reads an exact 64-bit integer.
  [[nodiscard]] bool integer(std::int64_t& value) const;

  // The member of an object; nothing if it is absent or this is not an object. Takes linear time.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;

  // The values of an array or an object, in order.
  class Items;
  [[nodiscard]] Items items() const;
  [[nodiscard]] bool empty() const;

  [[nodiscard]] bool fail_here(std::string what, Fault& fault) const;

 private:
  friend class JsonDocument;
  friend class JsonParser;
  JsonValue(const JsonDocument& document, std::uint32_t node) : document_(&document), node_(node) {}

  [[nodiscard]] std::string_view raw() const;

  const JsonDocument* document_;
  std::uint32_t node_;
};

class JsonDocument {
 public:
  // Parses a single value, surrounded by whitespace only. `text` must outlive the document.
  // `first_line` is the line number of its start.
  [[nodiscard]] bool parse(std::string_view text, Fault& fault, std::size_t first_line = 1);

  // Requires a parsed document.
  [[nodiscard]] JsonValue root() const { return {*this, 0}; }

 private:
  friend class JsonParser;
  friend class JsonValue;

  // The offset of a value, and the node after all values inside it. In an object, keys and values
  // alternate.
  struct Node {
    std::uint32_t begin, end;
  };

  [[nodiscard]] bool fail_at(std::size_t begin, std::string what, Fault& fault) const;

  std::string_view text_;
  std::size_t first_line_ = 1;
  std::deque<Node> nodes_;  // grows without copying
};

class JsonValue::Items {
 public:
  class Iterator {
   public:
    JsonValue operator*() const { return {*document_, value()}; }
    [[nodiscard]] JsonValue key() const {
      return {*document_, node_};
    }  // the key of an object's member
    Iterator& operator++();
    bool operator==(const Iterator& other) const { return node_ == other.node_; }

   private:
    friend class Items;
    Iterator(const JsonDocument& document, std::uint32_t node, bool keys)
        : document_(&document), node_(node), keys_(keys) {}
    [[nodiscard]] std::uint32_t value() const { return node_ + (keys_ ? 1 : 0); }

    const JsonDocument* document_;
    std::uint32_t node_;
    bool keys_;
  };

  [[nodiscard]] Iterator begin() const { return {*document_, begin_, keys_}; }
  [[nodiscard]] Iterator end() const { return {*document_, end_, keys_}; }

 private:
  friend class JsonValue;
  Items(const JsonDocument& document, std::uint32_t begin, std::uint32_t end, bool keys)
      : document_(&document), begin_(begin), end_(end), keys_(keys) {}

  const JsonDocument* document_;
  std::uint32_t begin_, end_;
  bool keys_;
};

// A JSON string with quotation marks.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace mien::animation
