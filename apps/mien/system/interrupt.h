// Polls for Ctrl-C and termination signals. posix/ and win32/ have one implementation each.
#pragma once

namespace mien::app {

// From then on SIGINT, SIGTERM and SIGHUP, or Ctrl-C and Ctrl-Break, only set `interrupted`.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace mien::app
