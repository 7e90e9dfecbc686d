// Detects whether standard output shows colours.
#include "apps/conformance/terminal.h"

#include <cstdlib>

#if defined(_WIN32)
#include <io.h>
#include <stdio.h>
#else
#include <unistd.h>
#endif

namespace mien::conformance {
namespace {

bool is_terminal() {
#if defined(_WIN32)
  return _isatty(_fileno(stdout)) != 0;
#else
  return isatty(STDOUT_FILENO) != 0;
#endif
}

Colours choose() {
  const char* no_colour = std::getenv("NO_COLOR");
  if (!is_terminal() || (no_colour != nullptr && *no_colour != '\0')) {
    return {};
  }
  return {"\033[32m", "\033[1;31m", "\033[2m", "\033[0m"};
}

}  // namespace

const Colours& colours() {
  static const Colours chosen = choose();
  return chosen;
}

}  // namespace mien::conformance
