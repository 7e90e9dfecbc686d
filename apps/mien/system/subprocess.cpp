// Runs ffmpeg and ffprobe with timeouts.
#include "apps/mien/system/subprocess.h"

#include <array>
#include <optional>
#include <utility>

namespace mien::app {

Failure cannot_run(const std::string& program, const std::string& reason) {
  return {kExitNoFfmpeg, "cannot run '" + program + "': " + reason +
                             "; install ffmpeg, for example with `apt install ffmpeg`, "
                             "`brew install ffmpeg` or `winget install ffmpeg`"};
}

Subprocess::Subprocess(const std::vector<std::string>& arguments, Pipe pipe,
                       std::chrono::milliseconds timeout)
    : name_(arguments[0]),
      timeout_(timeout),
      final_timeout_(pipe == Pipe::kToChild     ? kOutputTimeout
                     : timeout < timeout.zero() ? kTimeout
                                                : timeout),
      child_(ChildProcess::start(arguments, pipe)) {}

void Subprocess::kill_after_timeout(std::chrono::milliseconds after) {
  child_->kill();
  errors_ += child_->take_errors() + "[error] '" + name_ + "' was inactive for " +
             std::to_string(std::chrono::duration<double>(after).count()) + " s\n";
}

std::size_t Subprocess::read(std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::optional<std::size_t> n = child_->read(bytes.subspan(done), timeout_);
    if (!n) {
      kill_after_timeout(timeout_);
    }
    if (n.value_or(0) == 0) {
      break;
    }
    done += *n;
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
    const std::optional<std::size_t> n = child_->write(bytes, timeout_);
    if (!n) {
      kill_after_timeout(timeout_);
    }
    if (n.value_or(0) == 0) {
      return false;
    }
    bytes = bytes.subspan(*n);
  }
  return true;
}

void Subprocess::interrupt() { child_->kill(); }

int Subprocess::finish() {
  child_->close_pipe();
  std::optional<int> status = child_->wait(final_timeout_);
  if (!status) {
    kill_after_timeout(final_timeout_);
    status = child_->wait(kNoTimeout);
  }
  return *status;
}

std::string Subprocess::take_errors() { return std::exchange(errors_, {}) + child_->take_errors(); }

}  // namespace mien::app
