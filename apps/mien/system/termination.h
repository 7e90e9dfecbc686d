// Cleaning up when the user or the system ends the program; posix/ and win32/ have one each.
#pragma once

namespace mien::app {

// Something that must not outlive the program: a temporary file or a child process.
class Leftover {
 public:
  Leftover() = default;
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

  // Called in a signal handler: may use nothing but async-signal-safe functions.
  virtual void discard() noexcept = 0;

 protected:
  ~Leftover() = default;

 private:
  friend class TerminationLock;
  Leftover* older_ = nullptr;
};

// While a thread holds the lock, the program is not ended by a signal, and no other thread holds
// it. Create a leftover and add it under one lock, so that no signal comes between the two.
class TerminationLock {
 public:
  TerminationLock();
  ~TerminationLock();
  TerminationLock(const TerminationLock&) = delete;
  TerminationLock& operator=(const TerminationLock&) = delete;

  void add(Leftover& one);
  void remove(Leftover& one);  // does nothing if it was not added

  // The newest first: a child ends before the file it writes is removed. The caller holds the lock,
  // and never gives it back.
  static void discard_all() noexcept;
};

// From then on SIGINT, SIGTERM and SIGHUP (on Windows: Ctrl-C, Ctrl-Break, closing the console,
// logging off) discard all leftovers before they end the program. Ignored signals stay ignored.
void clean_up_on_termination();

}  // namespace mien::app
