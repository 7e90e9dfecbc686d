#include "formats/animation/json.h"

#include <algorithm>
#include <utility>

#include "formats/animation/numbers.h"

namespace mien::formats {
namespace {

constexpr int kMaxDepth = 64;  // arrays and objects inside each other

bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Parser {
 public:
  Parser(std::string_view text, std::size_t first_line, Fault& fault)
      : text_(text), line_(first_line), fault_(fault) {}

  bool parse_all(JsonValue& value) {
    if (!parse(value, 0)) {
      return false;
    }
    skip_blanks();
    return at_ == text_.size() || stop("nothing is expected here any more");
  }

 private:
  [[nodiscard]] bool stop(const char* what) const {
    return fail(fault_, line_, at_ - line_begin_ + 1, what);
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        line_begin_ = at_ + 1;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
      ++at_;
    }
  }

  bool take(char wanted) {
    if (at_ < text_.size() && text_[at_] == wanted) {
      ++at_;
      return true;
    }
    return false;
  }

  bool parse(JsonValue& value, int depth) {
    skip_blanks();
    value.line = line_;
    value.column = at_ - line_begin_ + 1;
    if (at_ == text_.size()) {
      return stop("a value is missing");
    }
    switch (text_[at_]) {
      case '{':
        return depth < kMaxDepth ? parse_object(value, depth) : stop("too deeply nested");
      case '[':
        return depth < kMaxDepth ? parse_array(value, depth) : stop("too deeply nested");
      case '"':
        value.kind = JsonValue::Kind::kString;
        return parse_string(value.text);
      case 't':
        value.truth = true;
        return parse_word("true", JsonValue::Kind::kBoolean, value);
      case 'f':
        return parse_word("false", JsonValue::Kind::kBoolean, value);
      case 'n':
        return parse_word("null", JsonValue::Kind::kNull, value);
      default:
        return parse_number_at(value);
    }
  }

  bool parse_object(JsonValue& value, int depth) {
    value.kind = JsonValue::Kind::kObject;
    ++at_;
    skip_blanks();
    if (take('}')) {
      return true;
    }
    do {
      skip_blanks();
      std::string key;
      if (at_ == text_.size() || text_[at_] != '"') {
        return stop("a key in quotation marks is missing");
      }
      const std::size_t key_at = at_;
      if (!parse_string(key)) {
        return false;
      }
      if (value.find(key) != nullptr) {
        at_ = key_at;
        return stop("this key appears twice");
      }
      skip_blanks();
      if (!take(':')) {
        return stop("':' is missing");
      }
      value.keys.push_back(std::move(key));
      value.items.emplace_back();
      if (!parse(value.items.back(), depth + 1)) {
        return false;
      }
      skip_blanks();
    } while (take(','));
    return take('}') || stop("',' or '}' is missing");
  }

  bool parse_array(JsonValue& value, int depth) {
    value.kind = JsonValue::Kind::kArray;
    ++at_;
    skip_blanks();
    if (take(']')) {
      return true;
    }
    do {
      value.items.emplace_back();
      if (!parse(value.items.back(), depth + 1)) {
        return false;
      }
      skip_blanks();
    } while (take(','));
    return take(']') || stop("',' or ']' is missing");
  }

  bool parse_word(std::string_view word, JsonValue::Kind kind, JsonValue& value) {
    if (text_.substr(at_, word.size()) != word) {
      return stop("is no value");
    }
    at_ += word.size();
    value.kind = kind;
    return true;
  }

  bool digits() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_digit(text_[at_])) {
      ++at_;
    }
    return at_ > begin;
  }

  bool parse_number_at(JsonValue& value) {
    const std::size_t begin = at_;
    take('-');
    bool good = take('0') || digits();
    if (good && take('.')) {
      good = digits();
    }
    if (good && (take('e') || take('E'))) {
      if (!take('+')) {
        take('-');
      }
      good = digits();
    }
    value.kind = JsonValue::Kind::kNumber;
    value.text = text_.substr(begin, at_ - begin);
    if (!good || !parse_number(value.text, value.number)) {
      at_ = begin;
      return stop("is no value");
    }
    return true;
  }

  bool parse_string(std::string& text) {
    ++at_;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        ++at_;
        return true;
      }
      if (static_cast<unsigned char>(c) < 0x20) {
        return stop("a control character in a string");
      }
      if (c == '\\') {
        if (!parse_escape(text)) {
          return false;
        }
      } else {
        text += c;
        ++at_;
      }
    }
    return stop("the string does not end");
  }

  bool parse_escape(std::string& text) {
    constexpr std::string_view kLetters = "\"\\/bfnrt";
    constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
    ++at_;
    if (take('u')) {
      return parse_code_point(text);
    }
    const std::size_t which = at_ < text_.size() ? kLetters.find(text_[at_]) : kLetters.npos;
    if (which == kLetters.npos) {
      return stop("no such escape");
    }
    text += kMeanings[which];
    ++at_;
    return true;
  }

  bool hex4(std::uint32_t& value) {
    value = 0;
    for (int i = 0; i < 4; ++i, ++at_) {
      constexpr std::string_view kHex = "0123456789abcdef";
      const std::size_t digit =
          at_ < text_.size() ? kHex.find(static_cast<char>(text_[at_] | 0x20)) : kHex.npos;
      const bool is_hex =
          at_ < text_.size() && digit != kHex.npos && (is_digit(text_[at_]) || digit >= 10);
      if (!is_hex) {
        return stop("four hexadecimal digits are missing");
      }
      value = value * 16 + static_cast<std::uint32_t>(digit);
    }
    return true;
  }

  bool parse_code_point(std::string& text) {
    std::uint32_t code = 0;
    if (!hex4(code)) {
      return false;
    }
    if (code >= 0xDC00 && code < 0xE000) {
      return stop("half a surrogate pair");
    }
    if (code >= 0xD800 && code < 0xDC00) {
      std::uint32_t low = 0;
      if (!take('\\') || !take('u') || !hex4(low) || low < 0xDC00 || low >= 0xE000) {
        return stop("half a surrogate pair");
      }
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    }
    append_utf8(code, text);
    return true;
  }

  static void append_utf8(std::uint32_t code, std::string& text) {
    if (code < 0x80) {
      text += static_cast<char>(code);
      return;
    }
    const int followers = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    constexpr std::uint32_t kFirst[] = {0, 0xC0, 0xE0, 0xF0};
    text += static_cast<char>(kFirst[followers] | (code >> (6 * followers)));
    for (int i = followers - 1; i >= 0; --i) {
      text += static_cast<char>(0x80 | ((code >> (6 * i)) & 0x3F));
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_;
  std::size_t line_begin_ = 0;
  Fault& fault_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

bool JsonValue::integer(std::int64_t& value) const {
  return kind == Kind::kNumber && parse_number(text, value);
}

bool parse_json(std::string_view text, JsonValue& value, Fault& fault, std::size_t first_line) {
  JsonValue parsed;
  if (!Parser(text, first_line, fault).parse_all(parsed)) {
    return false;
  }
  value = std::move(parsed);
  return true;
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

}  // namespace mien::formats
