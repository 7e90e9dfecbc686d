// Draws pages on a terminal.
#include "apps/mien/system/terminal.h"

#include <cstdio>

namespace mien::app {

// Switches to the alternate screen and hides the cursor; the destructor restores both.
Page::Page() : is_terminal_(error_is_terminal()) {
  if (is_terminal_) {
    std::fputs("\033[?1049h\033[?25l", stderr);
  }
}

Page::~Page() {
  if (is_terminal_) {
    std::fputs("\033[?25h\033[?1049l", stderr);
  }
}

void Page::draw(const std::string& lines) {
  if (!is_terminal_) {
    return;
  }
  std::string text = "\033[H";
  for (const char c : lines) {
    text += c == '\n' ? std::string("\033[K\n") : std::string(1, c);
  }
  std::fputs((text + "\033[J").c_str(), stderr);
}

}  // namespace mien::app
