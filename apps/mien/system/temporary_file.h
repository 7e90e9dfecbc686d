// A temporary file in the folder of its destination. posix/ and win32/ have one implementation
// each.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <system_error>

namespace mien::app {

class TemporaryFile {
 public:
  // kOfDestination keeps the ending, because other programs select the format by it.
  enum class Ending { kAny, kOfDestination };

  // Creates the file exclusively. If the file system permits and `ending` is kAny, the file has no
  // name, so it disappears however the program ends; otherwise it has an unpredictable name.
  // `error` receives the reason of a failure.
  TemporaryFile(const std::string& destination, Ending ending, std::error_code& error);
  ~TemporaryFile();  // removes the file unless it was published
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  // A path by which this and other programs can open it.
  [[nodiscard]] const std::string& name() const;

  // A stream to the file. The caller closes it before `publish`. Returns nullptr with errno on
  // failure.
  [[nodiscard]] std::FILE* open();

  // Moves the file to its destination. Replaces an existing file and keeps its mode and owner.
  // Replaces a symbolic link, not its target.
  [[nodiscard]] std::error_code publish();

 private:
  struct Native;
  std::unique_ptr<Native> native_;
};

}  // namespace mien::app
