#include "apps/mien/system/subprocess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

struct PipeEnds {
  int read_end;
  int write_end;
};

PipeEnds make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw Failure(kExitInternal, std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  return {ends[0], ends[1]};
}

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

  pid_t pid = -1;
  const int error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw Failure(kExitNoFfmpeg, "cannot run '" + arguments[0] + "': " + std::strerror(error));
  }
  return pid;
}

}  // namespace

Subprocess::Subprocess(const std::vector<std::string>& arguments, Pipe pipe,
                       std::chrono::milliseconds patience)
    : name_(arguments[0]), patience_(patience) {
  const PipeEnds data = make_pipe();
  const PipeEnds errors = make_pipe();
  const bool from_child = pipe == Pipe::kFromChild;
  const int child_end = from_child ? data.write_end : data.read_end;
  pipe_ = from_child ? data.read_end : data.write_end;
  errors_pipe_ = errors.read_end;
  fcntl(errors_pipe_, F_SETFL, O_NONBLOCK);
  fcntl(pipe_, F_SETFL, O_NONBLOCK);
  try {
    pid_ = spawn(arguments, from_child ? -1 : child_end, from_child ? child_end : -1,
                 errors.write_end);
  } catch (...) {
    for (const int end : {data.read_end, data.write_end, errors.read_end, errors.write_end}) {
      close(end);
    }
    throw;
  }
  close(child_end);
  close(errors.write_end);
}

Subprocess::~Subprocess() {
  close_pipe();
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (errors_pipe_ >= 0) {
    close(errors_pipe_);
  }
}

void Subprocess::close_pipe() {
  if (pipe_ >= 0) {
    close(pipe_);
    pipe_ = -1;
  }
}

void Subprocess::drain_errors(bool wait) {
  std::array<char, 4096> buffer{};
  while (errors_pipe_ >= 0) {
    const ssize_t n = ::read(errors_pipe_, buffer.data(), buffer.size());
    if (n > 0) {
      errors_.append(buffer.data(), static_cast<std::size_t>(n));
    } else if (n == 0) {
      close(errors_pipe_);
      errors_pipe_ = -1;
    } else if (errno == EAGAIN && wait) {
      pollfd waiting{errors_pipe_, POLLIN, 0};
      poll(&waiting, 1, -1);
    } else if (errno != EINTR) {
      return;
    }
  }
}

// Both pipes are watched: a child blocked on a full stderr would never get on with the other.
bool Subprocess::wait_for(short event) {
  std::array<pollfd, 2> waiting{pollfd{pipe_, event, 0}, pollfd{errors_pipe_, POLLIN, 0}};
  int happened = -1;
  do {
    happened = poll(waiting.data(), waiting.size(), static_cast<int>(patience_.count()));
  } while (happened < 0 && errno == EINTR);
  if (waiting[1].revents != 0) {
    drain_errors(false);
  }
  if (happened == 0) {
    kill(pid_, SIGKILL);
    errors_ += "[error] '" + name_ + "' did nothing for " +
               std::to_string(std::chrono::duration<double>(patience_).count()) + " s\n";
  }
  return happened > 0;
}

std::size_t Subprocess::read(std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(pipe_, bytes.data() + done, bytes.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n < 0 && errno == EAGAIN) {
      if (!wait_for(POLLIN)) {
        break;
      }
    } else if (n == 0 || errno != EINTR) {
      break;
    }
  }
  return done;
}

std::string Subprocess::read_all() {
  std::string text;
  std::array<std::byte, 4096> buffer{};
  for (;;) {
    const std::size_t n = read(buffer);
    text.append(reinterpret_cast<const char*>(buffer.data()), n);
    if (n < buffer.size()) {
      return text;
    }
  }
}

bool Subprocess::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(pipe_, bytes.data(), bytes.size());
    if (n >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN ? !wait_for(POLLOUT) : errno != EINTR) {
      return false;
    }
  }
  return true;
}

void Subprocess::interrupt() { kill(pid_, SIGKILL); }

int Subprocess::finish() {
  close_pipe();
  drain_errors(true);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string Subprocess::take_errors() {
  drain_errors(false);
  std::string taken;
  taken.swap(errors_);
  return taken;
}

}  // namespace mien::app
