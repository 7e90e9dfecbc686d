// Interrupts on Windows.
#include "apps/mien/system/interrupt.h"

#include <windows.h>

#include <atomic>

namespace mien::app {
namespace {

std::atomic<bool> caught = false;

// Called on a separate thread.
BOOL WINAPI catch_event(DWORD event) {
  const bool asks_to_end = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
  if (asks_to_end) {
    caught = true;
  }
  return asks_to_end ? TRUE : FALSE;
}

}  // namespace

void catch_interrupts() { SetConsoleCtrlHandler(catch_event, TRUE); }

bool interrupted() { return caught; }

}  // namespace mien::app
