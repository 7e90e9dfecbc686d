// Parses simple XML.
#include "apps/animation/xml.h"

#include <algorithm>
#include <array>
#include <optional>

#include "apps/animation/numbers.h"

namespace mien::animation {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

struct Entity {
  char character;
  std::string_view written;
};
constexpr std::array<Entity, 5> kEntities = {
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}}};

bool part_of_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.' || c == ':';
}

class XmlParser {
 public:
  XmlParser(std::string_view text, const XmlVisit& visit, Fault& fault)
      : text_(text), visit_(visit), fault_(fault) {}

  bool parse() {
    skip_blanks();
    while (at_ < text_.size()) {
      const bool fine = follows("<?") || follows("<!--") ? skip_declarations_and_comments() : tag();
      if (!fine || !take_text()) {
        return false;
      }
    }
    if (!open_.empty()) {
      return fail_here("<" + open_.back() + "> is not closed");
    }
    return last_ ? visit_(*last_) : fail_here("no element");
  }

 private:
  static constexpr std::size_t kMaxNesting = 64;  // maximum nesting, and attributes per element

  // Passes on the previous tag, whose text is now complete.
  bool add(XmlTag tag) {
    const bool goes_on = !last_ || visit_(*last_);
    last_ = std::move(tag);
    return goes_on;
  }

  bool fail_here(std::string what) {
    XmlTag here;
    place(here);
    return here.fail_here(std::move(what), fault_);
  }

  [[nodiscard]] bool follows(std::string_view what) const {
    return text_.substr(at_).starts_with(what);
  }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size()); }

  // Skips <?xml ...?> and comments.
  bool skip_declarations_and_comments() {
    const std::string_view end = follows("<?") ? "?>" : "-->";
    const std::size_t found = text_.find(end, at_ + 2);
    if (found == text_.npos) {
      return fail_here("expected " + std::string(end));
    }
    at_ = found + end.size();
    return true;
  }

  std::string name() {
    const std::size_t from = at_;
    while (at_ < text_.size() && part_of_a_name(text_[at_])) {
      ++at_;
    }
    return std::string(text_.substr(from, at_ - from));
  }

  bool tag() {
    XmlTag tag;
    place(tag);
    if (!follows("<")) {
      return fail_here("expected a tag");
    }
    ++at_;
    tag.closes = follows("/");
    at_ += tag.closes ? 1 : 0;
    tag.name = name();
    if (tag.name.empty()) {
      return fail_here("expected a tag name");
    }
    if (open_.empty() && last_) {
      return tag.fail_here("second root element", fault_);
    }
    return tag.closes ? close(tag) : open(tag);
  }

  // Counts lines from the last position on.
  void place(XmlTag& tag) {
    for (; counted_ < at_; ++counted_) {
      if (text_[counted_] == '\n') {
        ++line_;
        line_begin_ = counted_ + 1;
      }
    }
    tag.line = line_;
    tag.column = at_ - line_begin_ + 1;
  }

  bool close(XmlTag& tag) {
    skip_blanks();
    if (!follows(">")) {
      return fail_here("expected '>'");
    }
    ++at_;
    if (open_.empty() || open_.back() != tag.name) {
      return tag.fail_here("unexpected closing tag </" + tag.name + ">", fault_);
    }
    open_.pop_back();
    return add(std::move(tag));
  }

  bool open(XmlTag& tag) {
    skip_blanks();
    while (!follows(">") && !follows("/>")) {
      if (!attribute(tag)) {
        return false;
      }
      skip_blanks();
    }
    const bool empty = follows("/>");
    at_ += empty ? 2 : 1;
    if (open_.size() == kMaxNesting) {
      return tag.fail_here("too deeply nested", fault_);
    }
    if (!empty) {
      open_.push_back(tag.name);
      return add(std::move(tag));
    }
    XmlTag closing = tag;
    closing.closes = true;
    closing.attributes.clear();
    return add(std::move(tag)) && add(std::move(closing));
  }

  bool attribute(XmlTag& tag) {
    const std::string key = name();
    skip_blanks();
    if (key.empty() || !follows("=")) {
      return fail_here(key.empty() ? "expected an attribute or '>'" : "expected '='");
    }
    ++at_;
    skip_blanks();
    if (!follows("\"") && !follows("'")) {
      return fail_here("expected a quotation mark");
    }
    if (tag.attributes.size() == kMaxNesting) {
      return fail_here("more than " + std::to_string(kMaxNesting) + " attributes");
    }
    if (tag.find(key) != nullptr) {
      return fail_here("duplicate attribute " + quoted(key));
    }
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == text_.npos) {
      return fail_here("unterminated attribute value");
    }
    ++at_;
    std::string value;
    if (!decode(end, value)) {
      return false;
    }
    at_ = end + 1;
    tag.attributes.emplace_back(key, std::move(value));
    return true;
  }

  // Decodes entities from here to `end`.
  bool decode(std::size_t end, std::string& into) {
    while (at_ < end) {
      if (text_[at_] != '&') {
        into += text_[at_++];
        continue;
      }
      const auto* known = std::find_if(kEntities.begin(), kEntities.end(),
                                       [&](const Entity& each) { return follows(each.written); });
      if (known == kEntities.end()) {
        return fail_here("unknown entity");
      }
      into += known->character;
      at_ += known->written.size();
    }
    return true;
  }

  // Reads text up to the next tag.
  bool take_text() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    skip_blanks();
    if (at_ >= end) {
      return true;
    }
    if (open_.empty()) {
      return fail_here("text outside the root element");
    }
    std::string found;
    if (!decode(end, found)) {
      return false;
    }
    last_->text += trimmed(found, kBlanks);
    return true;
  }

  std::string_view text_;
  const XmlVisit& visit_;
  Fault& fault_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0, line_ = 1, line_begin_ = 0;
  std::vector<std::string> open_;
  std::optional<XmlTag> last_;
};

}  // namespace

const std::string* XmlTag::find(std::string_view attribute) const {
  for (const auto& [key, value] : attributes) {
    if (key == attribute) {
      return &value;
    }
  }
  return nullptr;
}

bool parse_xml(std::string_view text, const XmlVisit& visit, Fault& fault) {
  return XmlParser(text, visit, fault).parse();
}

std::string xml_text(std::string_view text) {
  std::string written;
  for (const char c : text) {
    const auto* known = std::find_if(kEntities.begin(), kEntities.end(),
                                     [c](const Entity& each) { return each.character == c; });
    known != kEntities.end() ? written += known->written : written += c;
  }
  return written;
}

}  // namespace mien::animation
