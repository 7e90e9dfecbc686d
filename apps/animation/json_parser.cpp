// Parses JSON.
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "apps/animation/json.h"
#include "apps/animation/json_text.h"
#include "apps/animation/numbers.h"

namespace mien::animation {

class JsonParser {
 public:
  JsonParser(JsonDocument& document, Fault& fault)
      : document_(document), text_(document.text_), fault_(fault) {}

  bool parse_all() {
    if (text_.size() >= std::numeric_limits<std::uint32_t>::max()) {
      return stop("the text is longer than 4 GB");
    }
    if (!parse(0)) {
      return false;
    }
    skip_blanks();
    return at_ == text_.size() || stop("trailing characters");
  }

 private:
  static constexpr int kMaxDepth = 64;  // of arrays and objects

  [[nodiscard]] bool stop(const char* what) const { return document_.fail_at(at_, what, fault_); }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

  bool take(char wanted) {
    const bool there = at_ < text_.size() && text_[at_] == wanted;
    at_ += there ? 1 : 0;
    return there;
  }

  [[nodiscard]] std::uint32_t count() const {
    return static_cast<std::uint32_t>(document_.nodes_.size());
  }

  std::uint32_t begin_node() {
    document_.nodes_.push_back({static_cast<std::uint32_t>(at_), count() + 1});
    return count() - 1;
  }

  bool parse(int depth) {
    skip_blanks();
    if (at_ == text_.size()) {
      return stop("expected a value");
    }
    const std::uint32_t node = begin_node();
    const bool good = parse_value(depth);
    document_.nodes_[node].end = count();
    return good && (text_[document_.nodes_[node].begin] != '{' || keys_differ(node));
  }

  bool parse_value(int depth) {
    switch (text_[at_]) {
      case '{':
        return depth < kMaxDepth ? parse_object(depth) : stop("too deeply nested");
      case '[':
        return depth < kMaxDepth ? parse_array(depth) : stop("too deeply nested");
      case '"':
        return parse_string();
      case 't':
        return parse_word("true");
      case 'f':
        return parse_word("false");
      case 'n':
        return parse_word("null");
      default:
        return parse_number_at();
    }
  }

  bool parse_object(int depth) {
    ++at_;
    skip_blanks();
    if (take('}')) {
      return true;
    }
    do {
      skip_blanks();
      if (at_ == text_.size() || text_[at_] != '"') {
        return stop("expected a key in quotation marks");
      }
      begin_node();
      if (!parse_string()) {
        return false;
      }
      skip_blanks();
      if (!take(':')) {
        return stop("expected ':'");
      }
      if (!parse(depth + 1)) {
        return false;
      }
      skip_blanks();
    } while (take(','));
    return take('}') || stop("expected ',' or '}'");
  }

  bool parse_array(int depth) {
    ++at_;
    skip_blanks();
    if (take(']')) {
      return true;
    }
    do {
      if (!parse(depth + 1)) {
        return false;
      }
      skip_blanks();
    } while (take(','));
    return take(']') || stop("expected ',' or ']'");
  }

  bool parse_word(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) {
      return stop("invalid value");
    }
    at_ += word.size();
    return true;
  }

  bool digits() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9') {
      ++at_;
    }
    return at_ > begin;
  }

  bool parse_number_at() {
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
    double number = 0.0;
    if (!good || !parse_number(text_.substr(begin, at_ - begin), number)) {
      at_ = begin;
      return stop("invalid value");
    }
    return true;
  }

  bool parse_string() {
    ++at_;
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == '"') {
        return true;
      }
      if (static_cast<unsigned char>(c) < 0x20) {
        --at_;
        return stop("a control character in a string");
      }
      if (c == '\\') {
        const char* wrong = nullptr;
        const std::size_t bytes = json_escape_bytes(text_.substr(at_), wrong);
        if (bytes == 0) {
          return stop(wrong);
        }
        at_ += bytes;
      }
    }
    return stop("unterminated string");
  }

  // Sorts hashes, so that an object of any size takes nearly linear time.
  bool keys_differ(std::uint32_t object) {
    keys_.clear();
    const JsonValue::Items members = JsonValue(document_, object).items();
    for (auto at = members.begin(); at != members.end(); ++at) {
      keys_.push_back(std::uint64_t{hash(at.key())} << 32 | at.key().node_);
    }
    std::sort(keys_.begin(), keys_.end());
    for (auto begin = keys_.begin(); begin != keys_.end();) {
      const auto end = std::find_if(
          begin, keys_.end(), [begin](std::uint64_t key) { return key >> 32 != *begin >> 32; });
      if (end - begin > 1 && !texts_differ(begin, end)) {
        return false;
      }
      begin = end;
    }
    return true;
  }

  // Compares keys with equal hashes: few, except in malicious files.
  bool texts_differ(std::vector<std::uint64_t>::iterator begin,
                    std::vector<std::uint64_t>::iterator end) {
    std::sort(begin, end, [this](std::uint64_t a, std::uint64_t b) {
      const int order = compare(a, b);
      return order != 0 ? order < 0 : a < b;
    });
    const auto twice = std::adjacent_find(
        begin, end, [this](std::uint64_t a, std::uint64_t b) { return compare(a, b) == 0; });
    return twice == end || key(twice[1]).fail_here("duplicate key", fault_);
  }

  // FNV-1a, 32 bits.
  static std::uint32_t hash(const JsonValue& key) {
    const std::optional<std::string_view> plain = key.plain_text();
    const std::string unescaped = plain ? std::string() : key.text();
    std::uint64_t value = 2166136261;
    for (const char c : plain.value_or(unescaped)) {
      value = (value ^ static_cast<unsigned char>(c)) * 16777619 & 0xFFFFFFFF;
    }
    return static_cast<std::uint32_t>(value);
  }

  // The lower half of the entry is the node.
  [[nodiscard]] JsonValue key(std::uint64_t entry) const {
    return {document_, static_cast<std::uint32_t>(entry & 0xFFFFFFFF)};
  }

  [[nodiscard]] int compare(std::uint64_t a, std::uint64_t b) const {
    const auto plain = key(a).plain_text(), other = key(b).plain_text();
    return plain && other ? plain->compare(*other) : key(a).text().compare(key(b).text());
  }

  std::vector<std::uint64_t> keys_;  // of the last object: hash and node each
  JsonDocument& document_;
  std::string_view text_;
  std::size_t at_ = 0;
  Fault& fault_;
};

bool JsonDocument::parse(std::string_view text, Fault& fault, std::size_t first_line) {
  text_ = text;
  first_line_ = first_line;
  nodes_.clear();
  return JsonParser(*this, fault).parse_all();
}

}  // namespace mien::animation
