#include "apps/mien/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "apps/mien/failure.h"

namespace mien::app {

std::string partial_name(const std::string& path) {
  const std::filesystem::path whole(path);
  return (whole.parent_path() / (".partial-" + whole.filename().string())).string();
}

void publish(const std::string& path) {
  if (std::rename(partial_name(path).c_str(), path.c_str()) != 0) {
    throw Failure(kExitOutput, path + ": cannot be written: " + std::strerror(errno));
  }
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  file_ = std::fopen(partial_name(path_).c_str(), "wb");
  if (file_ == nullptr) {
    fail();
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
    std::remove(partial_name(path_).c_str());
  }
}

void OutputFile::fail() {
  throw Failure(kExitOutput, path_ + ": cannot be written: " + std::strerror(errno));
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
    fail();
  }
}

void OutputFile::finish() {
  const bool whole = std::fflush(file_) == 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (!whole || !closed) {
    std::remove(partial_name(path_).c_str());
    fail();
  }
  publish(path_);
}

}  // namespace mien::app
