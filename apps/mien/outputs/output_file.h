// Files that appear under their names only when they are whole.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace mien::app {

// What stands for a file until that is whole: in the same folder, with the same ending.
class PartialFile {
 public:
  // Creates nothing yet. Throws Failure(kExitUsage) where another of this program stands for the
  // same file, whatever name that was given by: the two would be written into one.
  explicit PartialFile(const std::string& path);
  ~PartialFile();  // removes it
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  // It is whole: puts it in place of what may be there. Throws Failure(kExitOutput).
  void publish();

 private:
  std::string path_, name_;
  std::string target_;  // equal for all names of the file
  bool published_ = false;
};

// Writes and flushes; `wanted` becomes false where the reader has gone, which is no failure:
// nothing is written then any more. Throws Failure(kExitOutput) for all else that goes wrong.
void write_standard_output(std::string_view text, bool& wanted);

// At the end of the program: throws Failure(kExitOutput) unless all that was printed, by whatever
// function, has been written, or its reader has gone.
void finish_standard_output();

class OutputFile {
 public:
  // Throws Failure(kExitOutput) when it cannot be created, and what PartialFile throws.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  void write(std::string_view text);
  void finish();

 private:
  [[noreturn]] void fail();

  std::string path_;
  // None where the path is no file but a device or a pipe, in whose place none may be put.
  std::optional<PartialFile> partial_;
  std::FILE* file_ = nullptr;
};

}  // namespace mien::app
