#include "apps/mien/system/subprocess.h"

#include <array>
#include <optional>
#include <utility>

namespace mien::app {

Subprocess::Subprocess(const std::vector<std::string>& arguments, Pipe pipe,
                       std::chrono::milliseconds patience)
    : name_(arguments[0]),
      patience_(patience),
      last_patience_(pipe == Pipe::kToChild       ? kPatienceWithOutput
                     : patience < patience.zero() ? kPatience
                                                  : patience),
      child_(ChildProcess::start(arguments, pipe)) {}

void Subprocess::lose_patience(std::chrono::milliseconds after) {
  child_->kill();
  errors_ += child_->take_errors() + "[error] '" + name_ + "' did nothing for " +
             std::to_string(std::chrono::duration<double>(after).count()) + " s\n";
}

std::size_t Subprocess::read(std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::optional<std::size_t> n = child_->read(bytes.subspan(done), patience_);
    if (!n) {
      lose_patience(patience_);
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
    const std::optional<std::size_t> n = child_->write(bytes, patience_);
    if (!n) {
      lose_patience(patience_);
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
  std::optional<int> status = child_->wait(last_patience_);
  if (!status) {
    lose_patience(last_patience_);
    status = child_->wait(kEndless);
  }
  return *status;
}

std::string Subprocess::take_errors() { return std::exchange(errors_, {}) + child_->take_errors(); }

}  // namespace mien::app
