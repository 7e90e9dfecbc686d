// Publishes output files when they are complete.
#include "apps/mien/outputs/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/standard_streams.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

// /dev/stdout, /dev/fd/3 and /proc/self/fd/3 are names of open files. Replacing them would change
// their meaning for all programs.
bool names_descriptor(const std::string& path) {
  std::error_code unknown;
  const std::string folder = name_of(fs::weakly_canonical(path_of(path).parent_path(), unknown));
  return folder == "/dev" || folder == "/dev/fd" || folder.starts_with("/proc/");
}

bool is_special(const std::string& path) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path_of(path), unknown);
  return fs::exists(status) && (fs::is_other(status) || names_descriptor(path));
}

// Follows links in folder names, but not a link in place of the file, which is replaced.
std::string target_of(const std::string& path) {
  std::error_code unknown;
  const fs::path whole = fs::absolute(path_of(path), unknown);
  const fs::path folder = fs::weakly_canonical(whole.parent_path(), unknown);
  return name_of(unknown ? whole.lexically_normal() : folder / whole.filename());
}

struct Targets {
  std::mutex mutex;  // several threads write the files of a folder
  std::set<std::string> names;
};

Targets& open_targets() {
  static Targets all;
  return all;
}

[[noreturn]] void fail_standard_output() {
  throw Failure(kExitOutput,
                std::string("standard output: cannot be written: ") + std::strerror(errno));
}

void forget_target(const std::string& target) {
  const std::scoped_lock lock(open_targets().mutex);
  open_targets().names.erase(target);
}

[[noreturn]] void fail_output(const std::string& path, const std::error_code& error) {
  throw Failure(kExitOutput, path + ": cannot be written: " + error.message());
}

}  // namespace

PartialFile::PartialFile(const std::string& path, TemporaryFile::Ending ending)
    : path_(path), target_(target_of(path)) {
  {
    const std::scoped_lock lock(open_targets().mutex);
    if (!open_targets().names.insert(target_).second) {
      throw Failure(kExitUsage, path + ": duplicate output path");
    }
  }
  std::error_code error;
  file_.emplace(path, ending, error);
  if (error) {
    forget_target(target_);
    fail_output(path_, error);
  }
}

PartialFile::~PartialFile() { forget_target(target_); }

void PartialFile::publish() {
  if (const std::error_code error = file_->publish()) {
    fail_output(path_, error);
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
  if (!reader_has_closed()) {
    fail_standard_output();
  }
  wanted = false;
  std::clearerr(stdout);  // handled, so finish_standard_output must not report it again
}

void finish_standard_output() {
  // errno still has the reason of an earlier failed write.
  const bool failed_before = std::ferror(stdout) != 0;
  if ((std::fflush(stdout) != 0 || failed_before) && !reader_has_closed()) {
    fail_standard_output();
  }
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (!is_special(path)) {
    partial_.emplace(path, TemporaryFile::Ending::kAny);
  }
  file_ = partial_ ? partial_->open() : std::fopen(path.c_str(), "wb");
  if (file_ == nullptr) {
    fail();
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
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
    fail();
  }
  if (partial_) {
    partial_->publish();
  }
}

}  // namespace mien::app
