// Glob matching.
#include "apps/conformance/glob.h"

namespace mien::conformance {

// On a mismatch, the last star consumes one more character.
bool matches(std::string_view glob, std::string_view name) {
  std::size_t g = 0, n = 0, after_star = std::string_view::npos, taken = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      after_star = ++g;
      taken = n;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == name[n])) {
      ++g;
      ++n;
    } else if (after_star != std::string_view::npos) {
      g = after_star;
      n = ++taken;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') {
    ++g;
  }
  return g == glob.size();
}

}  // namespace mien::conformance
