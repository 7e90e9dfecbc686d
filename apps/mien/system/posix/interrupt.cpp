// Interrupts on POSIX systems.
#include "apps/mien/system/interrupt.h"

#include <signal.h>

namespace mien::app {
namespace {

volatile sig_atomic_t caught = 0;

void catch_signal(int) { caught = 1; }

}  // namespace

void catch_interrupts() {
  signal(SIGINT, catch_signal);
  signal(SIGTERM, catch_signal);
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) {  // ignored under nohup
    signal(SIGHUP, catch_signal);
  }
}

bool interrupted() { return caught != 0; }

}  // namespace mien::app
