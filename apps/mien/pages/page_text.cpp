// Inserts data into pages.
#include "apps/mien/pages/page_text.h"

#include <string_view>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"

namespace mien::app {

// '<' occurs only inside JSON strings, where it can be escaped.
std::string script_text(const nlohmann::ordered_json& json) {
  const std::string text = json_text(json, -1);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    c == '<' ? safe += "\\u003c" : safe += c;
  }
  return safe;
}

std::string filled(const char* page, const std::vector<Insertion>& insertions) {
  std::string_view rest = page;
  std::size_t size = rest.size();
  for (const Insertion& insertion : insertions) {
    size += insertion.text.size();
  }
  std::string whole;
  whole.reserve(size);
  for (const Insertion& insertion : insertions) {
    const std::size_t at = rest.find(insertion.mark);
    if (at == std::string_view::npos) {
      throw Failure(kExitInternal, "page: missing mark " + insertion.mark);
    }
    whole.append(rest.substr(0, at)).append(insertion.text);
    rest.remove_prefix(at + insertion.mark.size());
  }
  return whole.append(rest);
}

}  // namespace mien::app
