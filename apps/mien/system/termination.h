// Cleanup when the user or the system ends the program. posix/ and win32/ have one implementation
// each.
#pragma once

namespace mien::app {

// A resource that must not outlive the program: a temporary file or a child process.
class Leftover {
 public:
  Leftover() = default;
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

  // Called in a signal handler: only async-signal-safe functions are allowed.
  virtual void discard() noexcept = 0;

 protected:
  ~Leftover() = default;

 private:
  friend class TerminationLock;
  Leftover* older_ = nullptr;
};

// While a thread holds the lock, no signal ends the program, and no other thread holds it. Create a
// leftover and add it under one lock, so that no signal arrives in between.
class TerminationLock {
 public:
  TerminationLock();
  ~TerminationLock();
  TerminationLock(const TerminationLock&) = delete;
  TerminationLock& operator=(const TerminationLock&) = delete;

  void add(Leftover& leftover);
  void remove(Leftover& leftover);  // no effect if it was not added

  // Discards in reverse order: a child ends before the file that it writes is removed. The caller
  // must hold the lock and must not release it.
  static void discard_all() noexcept;
};

// From then on SIGINT, SIGTERM and SIGHUP (on Windows: Ctrl-C, Ctrl-Break, closing the console,
// logging off) discard all leftovers before they end the program. Ignored signals stay ignored.
void clean_up_on_termination();

}  // namespace mien::app
