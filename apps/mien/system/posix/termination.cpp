// Cleanup on signals on POSIX systems.
#include "apps/mien/system/termination.h"

#include <sched.h>
#include <signal.h>

#include <array>
#include <atomic>

namespace mien::app {
namespace {

constexpr std::array kEndingSignals = {SIGINT, SIGTERM, SIGHUP};

// Signal handlers cannot lock a mutex, but can wait for this flag: a thread that holds it has
// blocked the signals, so the handler never waits for the thread that it interrupted.
std::atomic_flag lock_flag;
sigset_t previous_mask;

void acquire() {
  while (lock_flag.test_and_set(std::memory_order_acquire)) {
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
  acquire();  // never released: resources that other threads create from now on would not be
              // cleaned up
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
  previous_mask = before;
}

TerminationLock::~TerminationLock() {
  const sigset_t before = previous_mask;
  lock_flag.clear(std::memory_order_release);
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
