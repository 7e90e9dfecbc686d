// Files that appear under their names only when they are whole.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace mien::app {

// The name a file has until it is whole: in the same folder, with the same ending.
std::string partial_name(const std::string& path);

// Renames a whole file from its partial name; throws Failure(kExitOutput).
void publish(const std::string& path);

// Writes and flushes; `wanted` becomes false where the reader has gone, which is no failure:
// nothing is written then any more. Throws Failure(kExitOutput) for all else that goes wrong.
void write_standard_output(std::string_view text, bool& wanted);

class OutputFile {
 public:
  explicit OutputFile(
      const std::string& path);  // throws Failure(kExitOutput) when it cannot be created
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  void write(std::string_view text);
  void finish();

 private:
  [[noreturn]] void fail();
  void discard();

  std::string path_;
  // Until it is whole; the path itself where that is no file but a device or a pipe, in whose place
  // none may be put.
  std::string written_;
  std::FILE* file_ = nullptr;
};

}  // namespace mien::app
