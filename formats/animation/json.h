// JSON (RFC 8259) with the place of each value, so that a reader can say not only that something is
// wrong but where: no JSON library in use tells the line and column of a value that it has read.
// Values stay in the text; a value takes 8 bytes, and has at least two bytes of text. Duplicate
// keys are a fault.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "formats/animation/fault.h"

namespace mien::formats {

class JsonDocument;

// A value of a document, which has to outlive it. Cheap to copy.
class JsonValue {
 public:
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

  [[nodiscard]] Kind kind() const;
  [[nodiscard]] bool is(Kind wanted) const { return kind() == wanted; }
  [[nodiscard]] bool truth() const;        // whether it is `true`
  [[nodiscard]] double number() const;     // 0 of what is no number
  [[nodiscard]] std::string text() const;  // of a string what it says, of others nothing
  // The same where nothing is escaped, without a copy.
  [[nodiscard]] std::optional<std::string_view> plain_text() const;
  // A whole number of 64 bits, exactly.
  [[nodiscard]] bool integer(std::int64_t& value) const;

  // The member of an object; nothing where there is none, and of what is no object. Takes time for
  // every member.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;

  // Values of an array, or of an object, one after the other.
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
  // One value and nothing but blanks around it. `text` has to outlive the document. `first_line` is
  // the line that the text begins with.
  [[nodiscard]] bool parse(std::string_view text, Fault& fault, std::size_t first_line = 1);

  // Of a document that was parsed.
  [[nodiscard]] JsonValue root() const { return {*this, 0}; }

 private:
  friend class JsonParser;
  friend class JsonValue;

  // Where in the text a value begins, and which node comes behind all that is in it. An object has
  // keys and values in turn.
  struct Node {
    std::uint32_t begin, end;
  };

  [[nodiscard]] bool fail_at(std::size_t begin, std::string what, Fault& fault) const;

  std::string_view text_;
  std::size_t first_line_ = 1;
  std::deque<Node> nodes_;  // grows without a copy
};

class JsonValue::Items {
 public:
  class Iterator {
   public:
    JsonValue operator*() const { return {*document_, value()}; }
    [[nodiscard]] JsonValue key() const { return {*document_, node_}; }  // of an object's member
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

// The text as a JSON string, in its quotation marks.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace mien::formats
