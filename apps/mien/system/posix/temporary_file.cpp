// Temporary files on POSIX systems, without a name where possible (O_TMPFILE).
#include "apps/mien/system/temporary_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>

#include "apps/mien/system/partial_name.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/termination.h"

namespace mien::app {
namespace {

constexpr int kAttempts = 100;  // to find an unused name

std::error_code last_error() { return {errno, std::generic_category()}; }

// The attributes of a regular file; nothing for other or missing files.
std::optional<struct stat> file_at(const std::string& name) {
  struct stat found = {};
  if (lstat(name.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) {
    return std::nullopt;
  }
  return found;
}

// Keeps the mode and owner of the replaced file. If the group cannot be kept, the new group gets
// only the permissions of others.
void take_over_mode_and_owner(int file, const struct stat& replaced) {
  if (fchown(file, replaced.st_uid, replaced.st_gid) != 0 &&
      fchown(file, static_cast<uid_t>(-1), replaced.st_gid) != 0) {
    errno = 0;
  }
  struct stat now = {};
  fstat(file, &now);
  mode_t mode = replaced.st_mode & 0777;
  if (now.st_gid != replaced.st_gid) {
    mode &= 0707 | (mode & 07) << 3;
  }
  fchmod(file, mode);
}

}  // namespace

struct TemporaryFile::Native final : Leftover {
  explicit Native(const std::string& whole)
      : destination(whole),
        folder(name_of((path_of(".") / path_of(whole)).parent_path())),
        replaced(file_at(whole)) {}
  ~Native() {
    if (file >= 0) {
      close(file);
    }
  }
  Native(const Native&) = delete;
  Native& operator=(const Native&) = delete;

  void discard() noexcept override { unlink(name.c_str()); }

  // Only the owner can read a replacement until it has the mode of the replaced file.
  [[nodiscard]] mode_t mode() const { return replaced ? 0600 : 0666; }
  [[nodiscard]] std::string partial(const std::string& ending) const {
    std::string result = folder;
    result.append("/").append(partial_name(ending));
    return result;
  }

  bool create_without_name();
  std::error_code create_named(const std::string& ending);
  std::error_code link_without_name() const;
  [[nodiscard]] std::error_code move_named() const;

  std::string destination, folder;
  std::string name;  // opens the file
  std::optional<struct stat> replaced;
  int file = -1;
  bool named = false;
};

#ifdef O_TMPFILE

namespace {

std::string name_of_descriptor(const char* process, int file) {
  return std::string("/proc/") + process + "/fd/" + std::to_string(file);
}

std::error_code link_file(int file, const std::string& name) {
  const std::string from = name_of_descriptor("self", file);
  const int done = linkat(AT_FDCWD, from.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
  return done == 0 ? std::error_code() : last_error();
}

}  // namespace

bool TemporaryFile::Native::create_without_name() {
  file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode());
  if (file < 0) {
    return false;
  }
  name = name_of_descriptor(std::to_string(getpid()).c_str(), file);
  if (access(name.c_str(), F_OK) != 0) {  // without /proc the file could never get a name
    close(file);
    file = -1;
  }
  return file >= 0;
}

// link() does not replace a file, so if the destination exists, the new file first gets a temporary
// name.
std::error_code TemporaryFile::Native::link_without_name() const {
  const std::error_code error = link_file(file, destination);
  if (error != std::errc::file_exists) {
    return error;
  }
  const std::string beside = partial("");
  if (const std::error_code failed = link_file(file, beside)) {
    return failed;
  }
  if (rename(beside.c_str(), destination.c_str()) == 0) {
    return {};
  }
  const std::error_code failed = last_error();
  unlink(beside.c_str());
  return failed;
}

#else

bool TemporaryFile::Native::create_without_name() { return false; }
std::error_code TemporaryFile::Native::link_without_name() const {
  return std::make_error_code(std::errc::not_supported);
}

#endif

std::error_code TemporaryFile::Native::create_named(const std::string& ending) {
  for (int i = 0; i < kAttempts; ++i) {
    name = partial(ending);
    file = ::open(name.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, mode());
    if (file >= 0) {
      named = true;
      return {};
    }
    if (errno != EEXIST) {
      return last_error();
    }
  }
  return std::make_error_code(std::errc::file_exists);
}

std::error_code TemporaryFile::Native::move_named() const {
  struct stat ours = {};
  const std::optional<struct stat> found = file_at(name);
  fstat(file, &ours);
  if (!found || found->st_dev != ours.st_dev || found->st_ino != ours.st_ino) {
    return std::make_error_code(std::errc::no_such_file_or_directory);
  }
  return rename(name.c_str(), destination.c_str()) == 0 ? std::error_code() : last_error();
}

TemporaryFile::TemporaryFile(const std::string& destination, Ending ending, std::error_code& error)
    : native_(std::make_unique<Native>(destination)) {
  TerminationLock lock;
  error.clear();
  if (ending == Ending::kAny && native_->create_without_name()) {
    return;
  }
  error = native_->create_named(name_of(path_of(destination).extension()));
  if (native_->named) {
    lock.add(*native_);
  }
}

TemporaryFile::~TemporaryFile() {
  TerminationLock lock;
  if (native_->named) {
    native_->discard();
    lock.remove(*native_);
  }
}

const std::string& TemporaryFile::name() const { return native_->name; }

std::FILE* TemporaryFile::open() {
  const int copy = fcntl(native_->file, F_DUPFD_CLOEXEC, 0);
  std::FILE* stream = copy < 0 ? nullptr : fdopen(copy, "wb");
  if (stream == nullptr && copy >= 0) {
    close(copy);
  }
  return stream;
}

std::error_code TemporaryFile::publish() {
  TerminationLock lock;
  if (const std::optional<struct stat> now = file_at(native_->destination)) {
    native_->replaced = now;
  }
  if (native_->replaced) {
    take_over_mode_and_owner(native_->file, *native_->replaced);
  }
  if (!native_->named) {
    return native_->link_without_name();
  }
  const std::error_code error = native_->move_named();
  if (!error) {
    lock.remove(*native_);
    native_->named = false;
  }
  return error;
}

}  // namespace mien::app
