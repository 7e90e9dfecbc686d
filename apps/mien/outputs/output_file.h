// Output files that appear under their names only when they are complete.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "apps/mien/system/temporary_file.h"

namespace mien::app {

// A temporary file that replaces the file at `path` when it is published.
class PartialFile {
 public:
  // Throws Failure(kExitUsage) if this program already writes the same file, under any name, and
  // Failure(kExitOutput) if the file cannot be created.
  PartialFile(const std::string& path, TemporaryFile::Ending ending);
  ~PartialFile();  // removes the file unless it was published
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  // A path by which other programs can open it.
  [[nodiscard]] const std::string& name() const { return file_->name(); }
  [[nodiscard]] std::FILE* open() { return file_->open(); }
  // Throws Failure(kExitOutput).
  void publish();

 private:
  std::string path_;
  std::string target_;  // equal for all names of the file
  std::optional<TemporaryFile> file_;
};

// Writes and flushes. Sets `wanted` to false if the reader has closed standard output, which is not
// an error; later calls write nothing. Throws Failure(kExitOutput) for other failures.
void write_standard_output(std::string_view text, bool& wanted);

// Must be called at the end of the program. Throws Failure(kExitOutput) unless everything printed,
// by any function, has been written, or the reader has closed.
void finish_standard_output();

class OutputFile {
 public:
  // Throws Failure(kExitOutput) if the file cannot be created, and the exceptions of PartialFile.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  void write(std::string_view text);
  void finish();

 private:
  [[noreturn]] void fail();

  std::string path_;
  // Empty if the path is a device or a pipe, which must not be replaced.
  std::optional<PartialFile> partial_;
  std::FILE* file_ = nullptr;
};

}  // namespace mien::app
