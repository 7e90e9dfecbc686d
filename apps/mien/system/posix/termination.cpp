#include "apps/mien/system/termination.h"

#include <sched.h>
#include <signal.h>

#include <array>
#include <atomic>

namespace mien::app {
namespace {

constexpr std::array kEndingSignals = {SIGINT, SIGTERM, SIGHUP};

// A mutex cannot be locked in a signal handler. This flag can: whoever holds it has blocked the
// signals, so the handler never waits for the thread that it interrupted.
std::atomic_flag held;
sigset_t mask_of_holder;

void acquire() {
  while (held.test_and_set(std::memory_order_acquire)) {
    sched_yield();
  }
}

sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : kEndingSignals) {
    sigaddset(&signals, number);
  }
  return signals;
}

void clean_up_and_end(int number) {
  acquire();  // for good: whatever another thread created now would be left behind
  TerminationLock::discard_all();
  signal(number, SIG_DFL);
  raise(number);  // takes effect when the handler returns
}

}  // namespace

TerminationLock::TerminationLock() {
  const sigset_t ending = ending_signals();
  sigset_t before;
  pthread_sigmask(SIG_BLOCK, &ending, &before);
  acquire();
  mask_of_holder = before;
}

TerminationLock::~TerminationLock() {
  const sigset_t before = mask_of_holder;
  held.clear(std::memory_order_release);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void clean_up_on_termination() {
  struct sigaction action = {};
  action.sa_handler = clean_up_and_end;
  action.sa_mask = ending_signals();
  for (const int number : kEndingSignals) {
    struct sigaction before = {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) {
      sigaction(number, &action, nullptr);
    }
  }
}

}  // namespace mien::app
