// Child processes on POSIX systems.
#include "apps/mien/system/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <utility>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/termination.h"

extern "C" char** environ;  // NOLINT(readability-redundant-declaration): no header of macOS has it

namespace mien::app {
namespace {

struct PipeEnds {
  int read_end;
  int write_end;
};

// Children inherit neither end. Not every system can create pipes with that flag.
PipeEnds make_pipe() {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    throw Failure(kExitInternal, std::string("cannot create a pipe: ") + std::strerror(errno));
  }
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
  return {ends[0], ends[1]};
}

// Serializes starts: children of two threads would inherit each other's pipes and never see their
// end.
std::mutex start_mutex;

pid_t spawn(const std::vector<std::string>& arguments, int child_stdin, int child_stdout,
            int child_stderr) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const auto connect = [&](int from, int to) {
    if (from >= 0) {
      posix_spawn_file_actions_adddup2(&actions, from, to);
    } else {
      posix_spawn_file_actions_addopen(&actions, to, "/dev/null", O_RDWR, 0);
    }
  };
  connect(child_stdin, STDIN_FILENO);
  connect(child_stdout, STDOUT_FILENO);
  connect(child_stderr, STDERR_FILENO);

  // This thread holds a lock that blocks signals; the child must not inherit the mask.
  posix_spawnattr_t attributes;
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);

  pid_t pid = -1;
  const int error = posix_spawnp(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw cannot_run(arguments[0], error == ENOENT ? "not on PATH" : std::strerror(error));
  }
  return pid;
}

class PosixChild final : public ChildProcess, private Leftover {
 public:
  PosixChild(const std::vector<std::string>& arguments, Pipe pipe);
  ~PosixChild() override;
  PosixChild(const PosixChild&) = delete;
  PosixChild& operator=(const PosixChild&) = delete;

  std::optional<std::size_t> read(std::span<std::byte> bytes,
                                  std::chrono::milliseconds timeout) override {
    return transfer([&] { return ::read(pipe_, bytes.data(), bytes.size()); }, POLLIN, timeout);
  }
  std::optional<std::size_t> write(std::span<const std::byte> bytes,
                                   std::chrono::milliseconds timeout) override {
    return transfer([&] { return ::write(pipe_, bytes.data(), bytes.size()); }, POLLOUT, timeout);
  }
  void close_pipe() override;
  void kill() override { ::kill(pid_, SIGKILL); }
  std::optional<int> wait(std::chrono::milliseconds timeout) override;
  std::string take_errors() override {
    drain_errors();
    return std::exchange(errors_, {});
  }

 private:
  template <class Transfer>
  std::optional<std::size_t> transfer(Transfer once, short event,
                                      std::chrono::milliseconds timeout);
  bool wait_for(short event, std::chrono::milliseconds timeout);
  void drain_errors();
  void discard() noexcept override;
  int reap();

  pid_t pid_ = -1;
  int pipe_ = -1;
  int errors_pipe_ = -1;
  std::string errors_;
};

PosixChild::PosixChild(const std::vector<std::string>& arguments, Pipe pipe) {
  const std::lock_guard<std::mutex> alone(start_mutex);
  const PipeEnds data = make_pipe();
  const PipeEnds errors = make_pipe();
  const bool from_child = pipe == Pipe::kFromChild;
  const int child_end = from_child ? data.write_end : data.read_end;
  pipe_ = from_child ? data.read_end : data.write_end;
  errors_pipe_ = errors.read_end;
  fcntl(errors_pipe_, F_SETFL, O_NONBLOCK);
  fcntl(pipe_, F_SETFL, O_NONBLOCK);
  try {
    TerminationLock lock;
    pid_ = spawn(arguments, from_child ? -1 : child_end, from_child ? child_end : -1,
                 errors.write_end);
    lock.add(*this);
  } catch (...) {
    for (const int end : {data.read_end, data.write_end, errors.read_end, errors.write_end}) {
      close(end);
    }
    throw;
  }
  close(child_end);
  close(errors.write_end);
}

PosixChild::~PosixChild() {
  PosixChild::close_pipe();
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    reap();
  }
  if (errors_pipe_ >= 0) {
    close(errors_pipe_);
  }
}

void PosixChild::close_pipe() {
  if (pipe_ >= 0) {
    close(pipe_);
    pipe_ = -1;
  }
}

void PosixChild::drain_errors() {
  std::array<char, 4096> buffer{};
  while (errors_pipe_ >= 0) {
    const ssize_t n = ::read(errors_pipe_, buffer.data(), buffer.size());
    if (n > 0) {
      errors_.append(buffer.data(), static_cast<std::size_t>(n));
    } else if (n == 0) {
      close(errors_pipe_);
      errors_pipe_ = -1;
    } else if (errno != EINTR) {
      return;
    }
  }
}

// Returns false if neither pipe has activity within the timeout.
bool PosixChild::wait_for(short event, std::chrono::milliseconds timeout) {
  std::array<pollfd, 2> waiting{pollfd{pipe_, event, 0}, pollfd{errors_pipe_, POLLIN, 0}};
  int happened = -1;
  do {
    happened = poll(waiting.data(), waiting.size(), static_cast<int>(timeout.count()));
  } while (happened < 0 && errno == EINTR);
  if (waiting[1].revents != 0) {
    drain_errors();
  }
  return happened > 0;
}

template <class Transfer>
std::optional<std::size_t> PosixChild::transfer(Transfer once, short event,
                                                std::chrono::milliseconds timeout) {
  for (;;) {
    const ssize_t n = once();
    if (n >= 0) {
      return static_cast<std::size_t>(n);
    }
    if (errno == EAGAIN) {
      if (!wait_for(event, timeout)) {
        return std::nullopt;
      }
    } else if (errno != EINTR) {
      return 0;
    }
  }
}

// Called in a signal handler. After it returns, the child has ended and creates no files.
void PosixChild::discard() noexcept {
  ::kill(pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

// Clears the process id under the lock, so that `discard` never kills another process with the same
// id.
int PosixChild::reap() {
  TerminationLock lock;
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  lock.remove(*this);
  pid_ = -1;
  return status;
}

// POSIX has no call that waits for a child and a pipe, so this polls with growing pauses.
std::optional<int> PosixChild::wait(std::chrono::milliseconds timeout) {
  constexpr int kLongestNapMs = 20;
  const auto began = std::chrono::steady_clock::now();
  for (int nap_ms = 0;; nap_ms = std::min(nap_ms + 1, kLongestNapMs)) {
    pollfd waiting{errors_pipe_, POLLIN, 0};  // poll ignores a closed pipe (-1)
    poll(&waiting, 1, nap_ms);
    drain_errors();
    siginfo_t ended = {};
    if (waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOWAIT | WNOHANG) == 0 &&
        ended.si_pid == pid_) {
      drain_errors();
      const int status = reap();
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    if (timeout >= timeout.zero() && std::chrono::steady_clock::now() - began > timeout) {
      return std::nullopt;
    }
  }
}

}  // namespace

std::unique_ptr<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments,
                                                  Pipe pipe) {
  return std::make_unique<PosixChild>(arguments, pipe);
}

}  // namespace mien::app
