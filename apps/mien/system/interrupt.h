// Ctrl-C, and being asked to end, as something to look at between two pieces of work; posix/ and
// win32/ have one each.
#pragma once

namespace mien::app {

// From then on SIGINT, SIGTERM and SIGHUP, or Ctrl-C and Ctrl-Break, do nothing but make
// `interrupted` true.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace mien::app
