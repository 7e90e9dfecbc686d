#include "apps/mien/system/termination.h"

#include <windows.h>

#include <mutex>

namespace mien::app {
namespace {

std::mutex mutex;

// Runs in a thread of its own. What follows is what the system does with the event.
BOOL WINAPI clean_up(DWORD) {
  mutex.lock();  // for good: whatever another thread created now would be left behind
  TerminationLock::discard_all();
  return FALSE;
}

}  // namespace

TerminationLock::TerminationLock() { mutex.lock(); }

TerminationLock::~TerminationLock() { mutex.unlock(); }

void clean_up_on_termination() { SetConsoleCtrlHandler(clean_up, TRUE); }

}  // namespace mien::app
