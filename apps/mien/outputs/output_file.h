// Files that appear under their names only when they are whole.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "apps/mien/system/temporary_file.h"

namespace mien::app {

// A temporary file that replaces the file at `path` when that is whole.
class PartialFile {
 public:
  // Throws Failure(kExitUsage) if this program is already writing the same file, under whatever
  // name, and Failure(kExitOutput) if the file cannot be created.
  PartialFile(const std::string& path, TemporaryFile::Ending ending);
  ~PartialFile();  // removes it unless it was published
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  // Under which other programs can open it.
  [[nodiscard]] const std::string& name() const { return file_->name(); }
  [[nodiscard]] std::FILE* open() { return file_->open(); }
  // Throws Failure(kExitOutput).
  void publish();

 private:
  std::string path_;
  std::string target_;  // equal for all names of the file
  std::optional<TemporaryFile> file_;
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
