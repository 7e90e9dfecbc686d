// A file in the making, in the folder of the file that it will become; posix/ and win32/ have one
// each.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <system_error>

namespace mien::app {

class TemporaryFile {
 public:
  // Other programs choose the format of a file by the ending of its name.
  enum class Ending { kAny, kOfDestination };

  // Creates the file exclusively: without a name where the file system allows that and `ending`
  // does not matter, so that nothing is left behind however the program ends; otherwise under an
  // unpredictable name. `error` says why it failed.
  TemporaryFile(const std::string& destination, Ending ending, std::error_code& error);
  ~TemporaryFile();  // removes it unless it was published
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  // Under which this and other programs can open it.
  [[nodiscard]] const std::string& name() const;

  // A stream to it. The caller closes it before `publish`. nullptr: errno says why.
  [[nodiscard]] std::FILE* open();

  // Moves it to its destination. Replaces a file that is there, and takes over that file's mode and
  // owner; replaces a symbolic link rather than what it leads to.
  [[nodiscard]] std::error_code publish();

 private:
  struct Native;
  std::unique_ptr<Native> native_;
};

}  // namespace mien::app
