// Another program connected by pipes. Used for ffmpeg and ffprobe; POSIX.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mien::app {

class Subprocess {
 public:
  enum class Pipe { kToChild, kFromChild };

  // Starts arguments[0], found on PATH. kFromChild connects the child's stdout, kToChild its stdin;
  // stderr is always collected. Throws Failure(kExitNoFfmpeg) when the program is not there.
  Subprocess(const std::vector<std::string>& arguments, Pipe pipe);
  ~Subprocess();
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  // Reads until `bytes` is full or the child closes its end; returns how many bytes came.
  std::size_t read(std::span<std::byte> bytes);
  std::string read_all();

  // False when the child has gone away.
  bool write(std::span<const std::byte> bytes);

  // Closes the pipe and waits. Returns the exit status, 128 + signal when killed.
  int finish();

  // What the child has said on stderr so far and nobody has taken; empties it.
  std::string take_errors();

 private:
  void drain_errors(bool wait);
  void close_pipe();

  pid_t pid_ = -1;
  int pipe_ = -1;
  int errors_pipe_ = -1;
  std::string errors_;
};

}  // namespace mien::app
