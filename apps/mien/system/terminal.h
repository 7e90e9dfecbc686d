// The terminal as a screen and a keyboard. posix/ and win32/ have the keyboard and the question,
// each.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace mien::app {

// Whether standard error is a terminal; if so it takes escape sequences from then on.
[[nodiscard]] bool error_is_terminal();

// Keys as they are pressed, without waiting for a line. The terminal is as it was afterwards.
class Keyboard {
 public:
  // Of standard input; none where that is no terminal.
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  // The next key that was pressed and not taken yet; does not wait.
  std::optional<char> pressed();

 private:
  struct Settings;
  std::unique_ptr<Settings> before_;
};

// A page of lines on standard error in place of what was there, which comes back afterwards.
class Page {
 public:
  Page();  // of nothing where standard error is no terminal
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  [[nodiscard]] bool there() const { return there_; }
  void draw(const std::string& lines);

 private:
  bool there_;
};

}  // namespace mien::app
