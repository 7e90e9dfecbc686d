// Keyboard input on POSIX systems.
#include "apps/mien/system/terminal.h"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace mien::app {

bool error_is_terminal() { return isatty(STDERR_FILENO) != 0; }

struct Keyboard::Settings {
  termios of_terminal;
};

Keyboard::Keyboard() {
  Settings settings;
  if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &settings.of_terminal) != 0) {
    return;
  }
  before_ = std::make_unique<Settings>(settings);
  settings.of_terminal.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C still interrupts
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

}  // namespace mien::app
