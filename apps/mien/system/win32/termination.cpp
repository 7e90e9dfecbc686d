// Cleanup on console events on Windows.
#include "apps/mien/system/termination.h"

#include <windows.h>

#include <mutex>

namespace mien::app {
namespace {

std::mutex mutex;

// Called on a separate thread. Afterwards the system handles the event.
BOOL WINAPI clean_up(DWORD) {
  mutex.lock();  // never released: resources that other threads create from now on would not be
                 // cleaned up
  TerminationLock::discard_all();
  return FALSE;
}

}  // namespace

TerminationLock::TerminationLock() { mutex.lock(); }

TerminationLock::~TerminationLock() { mutex.unlock(); }

void clean_up_on_termination() { SetConsoleCtrlHandler(clean_up, TRUE); }

}  // namespace mien::app
