// Another program connected by pipes. Used for ffmpeg and ffprobe.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/system/child_process.h"

namespace mien::app {

class Subprocess {
 public:
  using Pipe = ChildProcess::Pipe;

  // How long a child that reads or writes files may do nothing.
  static constexpr std::chrono::seconds kPatience{60};
  // How long a child may take that has all of its input: it may have a file to move about.
  static constexpr std::chrono::minutes kPatienceWithOutput{30};
  static constexpr std::chrono::milliseconds kEndless{-1};

  // Starts arguments[0], found on PATH. kFromChild connects the child's stdout, kToChild its stdin;
  // stderr is always collected. Throws Failure(kExitNoFfmpeg) when the program is not there. A
  // child from which `read`, or for which `write`, waits longer than `patience` is killed.
  Subprocess(const std::vector<std::string>& arguments, Pipe pipe,
             std::chrono::milliseconds patience = kEndless);
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

  // Closes the pipe and waits. Returns the exit status, 128 + signal when killed, as a child is
  // that does not end.
  int finish();

  // What the child has said on stderr so far and nobody has taken; empties it.
  std::string take_errors();

 private:
  void lose_patience(std::chrono::milliseconds after);

  const std::string name_;
  const std::chrono::milliseconds patience_;
  const std::chrono::milliseconds last_patience_;  // once the pipe is closed
  const std::unique_ptr<ChildProcess> child_;
  std::string errors_;
};

}  // namespace mien::app
