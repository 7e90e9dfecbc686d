#include "apps/mien/system/terminal.h"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>

namespace mien::app {

struct Keyboard::Settings {
  termios of_terminal;
};

Keyboard::Keyboard() {
  Settings settings;
  if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &settings.of_terminal) != 0) {
    return;
  }
  before_ = std::make_unique<Settings>(settings);
  settings.of_terminal.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C still is one
  tcsetattr(STDIN_FILENO, TCSANOW, &settings.of_terminal);
}

Keyboard::~Keyboard() {
  if (before_) {
    tcsetattr(STDIN_FILENO, TCSANOW, &before_->of_terminal);
  }
}

std::optional<char> Keyboard::pressed() {
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (!before_ || poll(&waiting, 1, 0) <= 0 || read(STDIN_FILENO, &key, 1) != 1) {
    return std::nullopt;
  }
  return key;
}

// Another screen, without a cursor; and back.
Page::Page() : there_(isatty(STDERR_FILENO) != 0) {
  if (there_) {
    std::fputs("\033[?1049h\033[?25l", stderr);
  }
}

Page::~Page() {
  if (there_) {
    std::fputs("\033[?25h\033[?1049l", stderr);
  }
}

void Page::draw(const std::string& lines) {
  if (!there_) {
    return;
  }
  std::string text = "\033[H";
  for (const char c : lines) {
    text += c == '\n' ? std::string("\033[K\n") : std::string(1, c);
  }
  std::fputs((text + "\033[J").c_str(), stderr);
}

}  // namespace mien::app
