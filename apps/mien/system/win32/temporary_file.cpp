// Temporary files on Windows.
#include "apps/mien/system/temporary_file.h"

#include <windows.h>

#include <fcntl.h>
#include <io.h>

#include <cerrno>

#include "apps/mien/system/partial_name.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/termination.h"

namespace mien::app {
namespace {

constexpr int kAttempts = 100;  // to find an unused name
// An open file can be removed only if it was opened with these flags.
constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

std::error_code last_error() { return {static_cast<int>(GetLastError()), std::system_category()}; }

// Keeps the access list, attributes and creation time of a replaced file.
bool move_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  const DWORD attributes = GetFileAttributesW(to.c_str());
  const bool replaces =
      attributes != INVALID_FILE_ATTRIBUTES &&
      (attributes & (FILE_ATTRIBUTE_REPARSE_POINT | FILE_ATTRIBUTE_DIRECTORY)) == 0;
  return (replaces && ReplaceFileW(to.c_str(), from.c_str(), nullptr,
                                   REPLACEFILE_IGNORE_MERGE_ERRORS, nullptr, nullptr) != 0) ||
         MoveFileExW(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING) != 0;
}

}  // namespace

struct TemporaryFile::Native final : Leftover {
  void discard() noexcept override { DeleteFileW(path.c_str()); }
  std::error_code create(const std::string& ending);

  std::filesystem::path destination, path;
  std::string name;
  bool there = false;
};

std::error_code TemporaryFile::Native::create(const std::string& ending) {
  for (int i = 0; i < kAttempts; ++i) {
    path = destination.parent_path() / path_of(partial_name(ending));
    HANDLE file = CreateFileW(path.c_str(), GENERIC_WRITE, kShared, nullptr, CREATE_NEW,
                              FILE_ATTRIBUTE_NORMAL, nullptr);
    if (file != INVALID_HANDLE_VALUE) {
      CloseHandle(file);
      there = true;
      return {};
    }
    if (GetLastError() != ERROR_FILE_EXISTS) {
      return last_error();
    }
  }
  return std::make_error_code(std::errc::file_exists);
}

TemporaryFile::TemporaryFile(const std::string& destination, Ending, std::error_code& error)
    : native_(std::make_unique<Native>()) {
  native_->destination = path_of(destination);
  TerminationLock lock;
  error = native_->create(name_of(native_->destination.extension()));
  native_->name = name_of(native_->path);
  if (native_->there) {
    lock.add(*native_);
  }
}

TemporaryFile::~TemporaryFile() {
  TerminationLock lock;
  if (native_->there) {
    native_->discard();
    lock.remove(*native_);
  }
}

const std::string& TemporaryFile::name() const { return native_->name; }

std::FILE* TemporaryFile::open() {
  HANDLE file = CreateFileW(native_->path.c_str(), GENERIC_WRITE, kShared, nullptr, OPEN_EXISTING,
                            FILE_ATTRIBUTE_NORMAL, nullptr);
  if (file == INVALID_HANDLE_VALUE) {
    errno = EACCES;
    return nullptr;
  }
  const int descriptor = _open_osfhandle(reinterpret_cast<intptr_t>(file), _O_BINARY);
  std::FILE* stream = descriptor < 0 ? nullptr : _fdopen(descriptor, "wb");
  if (stream == nullptr) {
    CloseHandle(file);
  }
  return stream;
}

std::error_code TemporaryFile::publish() {
  TerminationLock lock;
  if (!move_file(native_->path, native_->destination)) {
    return last_error();
  }
  lock.remove(*native_);
  native_->there = false;
  return {};
}

}  // namespace mien::app
