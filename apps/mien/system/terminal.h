// The terminal as a screen and a keyboard. posix/ and win32/ implement the keyboard and the
// terminal check.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace mien::app {

// Whether standard error is a terminal. If so, it interprets escape sequences from now on.
[[nodiscard]] bool error_is_terminal();

// Reads single keys without waiting for a line. The destructor restores the terminal.
class Keyboard {
 public:
  // Reads standard input; inactive if that is not a terminal.
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  // Returns the next key, if one was pressed. Does not wait.
  std::optional<char> pressed();

 private:
  struct Settings;
  std::unique_ptr<Settings> before_;
};

// A page of text on standard error. The destructor restores the previous content.
class Page {
 public:
  Page();  // inactive if standard error is not a terminal
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  [[nodiscard]] bool is_terminal() const { return is_terminal_; }
  void draw(const std::string& lines);

 private:
  bool is_terminal_;
};

}  // namespace mien::app
