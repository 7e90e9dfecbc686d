// Another program connected by pipes. Used for ffmpeg and ffprobe; POSIX.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mien::app {

class Subprocess {
 public:
  enum class Pipe { kToChild, kFromChild };

  // How long a child that reads or writes files may do nothing.
  static constexpr std::chrono::seconds kPatience{60};
  static constexpr std::chrono::milliseconds kEndless{-1};

  // Starts arguments[0], found on PATH. kFromChild connects the child's stdout, kToChild its stdin;
  // stderr is always collected. Throws Failure(kExitNoFfmpeg) when the program is not there. A
  // child from which `read`, or for which `write`, waits longer than `patience` is killed.
  Subprocess(const std::vector<std::string>& arguments, Pipe pipe,
             std::chrono::milliseconds patience = kEndless);
  ~Subprocess();
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  // Reads until `bytes` is full or the child closes its end; returns how many bytes came.
  std::size_t read(std::span<std::byte> bytes);
  std::string read_all();

  // False when the child has gone away.
  bool write(std::span<const std::byte> bytes);

  // Makes the child end, whatever it does, so that a read in another thread returns; not once
  // `finish` was called.
  void interrupt();

  // Closes the pipe and waits. Returns the exit status, 128 + signal when killed.
  int finish();

  // What the child has said on stderr so far and nobody has taken; empties it.
  std::string take_errors();

 private:
  // False, and the child is killed, when nothing happens with either pipe.
  bool wait_for(short event);
  void drain_errors(bool wait);
  void close_pipe();

  const std::string name_;
  const std::chrono::milliseconds patience_;
  pid_t pid_ = -1;
  int pipe_ = -1;
  int errors_pipe_ = -1;
  std::string errors_;
};

}  // namespace mien::app
