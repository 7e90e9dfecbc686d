#include "apps/mien/outputs/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/standard_streams.h"

namespace mien::app {
namespace {

bool is_special(const std::string& path) {
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(path_of(path), unknown);
  return std::filesystem::exists(status) && std::filesystem::is_other(status);
}

}  // namespace

std::string partial_name(const std::string& path) {
  const std::filesystem::path whole = path_of(path);
  return name_of(whole.parent_path() / path_of(".partial-" + name_of(whole.filename())));
}

void publish(const std::string& path) {
  std::error_code error;
  std::filesystem::rename(path_of(partial_name(path)), path_of(path),
                          error);  // in place of one that is there
  if (error) {
    throw Failure(kExitOutput, path + ": cannot be written: " + error.message());
  }
}

void write_standard_output(std::string_view text, bool& wanted) {
  if (!wanted) {
    return;
  }
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && (!text.empty() || std::fflush(stdout) == 0)) {
    return;
  }
  if (!reader_has_gone()) {
    throw Failure(kExitOutput,
                  std::string("standard output: cannot be written: ") + std::strerror(errno));
  }
  wanted = false;
}

OutputFile::OutputFile(const std::string& path)
    : path_(path), written_(is_special(path) ? path : partial_name(path)) {
  file_ = std::fopen(written_.c_str(), "wb");
  if (file_ == nullptr) {
    fail();
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
    discard();
  }
}

void OutputFile::discard() {
  if (written_ != path_) {
    std::remove(written_.c_str());
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
  const bool whole = std::fflush(file_) == 0 && std::ferror(file_) == 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (!whole || !closed) {
    discard();
    fail();
  }
  if (written_ != path_) {
    publish(path_);
  }
}

}  // namespace mien::app
