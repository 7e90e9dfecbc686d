// A text file that appears under its name only when it is whole.
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

class OutputFile {
 public:
  explicit OutputFile(std::string path);  // throws Failure(kExitOutput) when it cannot be created
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  void write(std::string_view text);
  void finish();

 private:
  [[noreturn]] void fail();

  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace mien::app
