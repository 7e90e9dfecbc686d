// Keyboard input on Windows.
#include "apps/mien/system/terminal.h"

#include <windows.h>

#include <conio.h>

namespace mien::app {

bool error_is_terminal() {
  HANDLE error = GetStdHandle(STD_ERROR_HANDLE);
  DWORD mode = 0;
  return GetConsoleMode(error, &mode) != 0 &&
         SetConsoleMode(error, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

// The console needs no setting for single keys; the existence of settings indicates a console.
struct Keyboard::Settings {};

Keyboard::Keyboard() {
  DWORD mode = 0;
  if (GetConsoleMode(GetStdHandle(STD_INPUT_HANDLE), &mode) != 0) {
    before_ = std::make_unique<Settings>();
  }
}

Keyboard::~Keyboard() = default;

std::optional<char> Keyboard::pressed() {
  if (!before_ || _kbhit() == 0) {
    return std::nullopt;
  }
  return static_cast<char>(_getch());
}

}  // namespace mien::app
