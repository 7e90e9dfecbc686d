// Child processes on Windows.
#include "apps/mien/system/child_process.h"

#include <windows.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <system_error>
#include <utility>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/program_path.h"
#include "apps/mien/system/termination.h"

namespace mien::app {
namespace {

constexpr UINT kKilled = 128 + 9;  // the status of a child killed by SIGKILL

struct Close {
  using pointer = HANDLE;
  void operator()(HANDLE handle) const { CloseHandle(handle); }
};
using Handle = std::unique_ptr<void, Close>;

std::string last_error() {
  return std::system_category().message(static_cast<int>(GetLastError()));
}

// Converts UTF-8 to UTF-16 through std::filesystem::path.
std::wstring wide(const std::string& text) { return path_of(text).wstring(); }

Handle checked(HANDLE handle, const char* what) {
  if (handle == nullptr || handle == INVALID_HANDLE_VALUE) {
    throw Failure(kExitInternal, std::string("cannot create ") + what + ": " + last_error());
  }
  return Handle(handle);
}

// An inheritable handle. The child inherits only the handles of its list.
Handle open_for_child(const std::wstring& name, DWORD access) {
  SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
  return checked(CreateFileW(name.c_str(), access, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited,
                             OPEN_EXISTING, 0, nullptr),
                 "an end of a pipe");
}

// Our end of a pipe. Transfers are asynchronous; an event signals their end.
class PipeEnd {
 public:
  PipeEnd() : ended_(checked(CreateEventW(nullptr, TRUE, FALSE, nullptr), "an event")) {}
  ~PipeEnd() { cancel(); }
  PipeEnd(const PipeEnd&) = delete;
  PipeEnd& operator=(const PipeEnd&) = delete;

  // Returns the child's end. Only named pipes support asynchronous transfers.
  Handle open(bool from_child) {
    constexpr DWORD kBytes = 1 << 16;
    static std::atomic<unsigned> result = 0;
    const std::wstring name = L"\\\\.\\pipe\\mien-" + std::to_wstring(GetCurrentProcessId()) +
                              L"-" + std::to_wstring(result++);
    const DWORD access = from_child ? PIPE_ACCESS_INBOUND : PIPE_ACCESS_OUTBOUND;
    pipe_ = checked(CreateNamedPipeW(
                        name.c_str(), access | FILE_FLAG_OVERLAPPED | FILE_FLAG_FIRST_PIPE_INSTANCE,
                        PIPE_TYPE_BYTE | PIPE_REJECT_REMOTE_CLIENTS, 1, kBytes, kBytes, 0, nullptr),
                    "a pipe");
    return open_for_child(name, from_child ? GENERIC_WRITE : GENERIC_READ);
  }

  void begin_read(std::span<std::byte> bytes) {
    prepare();
    check(ReadFile(pipe_.get(), bytes.data(), size_of(bytes), nullptr, &transfer_));
  }
  void begin_write(std::span<const std::byte> bytes) {
    prepare();
    check(WriteFile(pipe_.get(), bytes.data(), size_of(bytes), nullptr, &transfer_));
  }

  [[nodiscard]] HANDLE ended() const { return ended_.get(); }

  // The number of bytes of the finished transfer; 0: the child closed its end.
  std::size_t moved() {
    DWORD bytes = 0;
    open_ = open_ && GetOverlappedResult(pipe_.get(), &transfer_, &bytes, TRUE) != 0;
    under_way_ = false;
    return open_ ? bytes : 0;
  }

  void cancel() {
    if (under_way_) {
      CancelIoEx(pipe_.get(), &transfer_);
      moved();
    }
  }

  void close() {
    cancel();
    pipe_.reset();
    open_ = false;
  }
  [[nodiscard]] bool open() const { return open_; }

 private:
  static DWORD size_of(std::span<const std::byte> bytes) {
    constexpr std::size_t kMaxBytes = 1 << 30;
    return static_cast<DWORD>(std::min(bytes.size(), kMaxBytes));
  }
  void prepare() {
    ResetEvent(ended_.get());
    transfer_ = {};
    transfer_.hEvent = ended_.get();
  }
  void check(BOOL done) {
    under_way_ = done != 0 || GetLastError() == ERROR_IO_PENDING;
    if (!under_way_) {
      open_ = false;
      SetEvent(ended_.get());
    }
  }

  Handle ended_;
  Handle pipe_;
  OVERLAPPED transfer_ = {};
  bool under_way_ = false;
  bool open_ = true;
};

// Quotes an argument for the C library of the child: backslashes are special only before a quote.
std::wstring quoted(const std::wstring& argument) {
  std::wstring result = L"\"";
  std::size_t backslashes = 0;
  for (const wchar_t c : argument) {
    if (c == L'"') {
      result.append(backslashes + 1, L'\\');
    }
    backslashes = c == L'\\' ? backslashes + 1 : 0;
    result += c;
  }
  return result.append(backslashes, L'\\') + L'"';
}

std::wstring command_line(const std::vector<std::string>& arguments) {
  std::wstring result;
  for (const std::string& argument : arguments) {
    result += quoted(wide(argument)) + L' ';
  }
  return result;
}

std::wstring environment_variable(const wchar_t* name) {
  std::wstring value(GetEnvironmentVariableW(name, nullptr, 0), L'\0');
  value.resize(GetEnvironmentVariableW(name, value.data(), static_cast<DWORD>(value.size())));
  return value;
}

// Searches the folder of this program, then PATH. Excludes the current folder, where an attacker
// may have put a program.
std::wstring find_program(const std::string& name) {
  const std::wstring folders =
      program_path().parent_path().wstring() + L';' + environment_variable(L"PATH");
  std::array<wchar_t, 32768> found{};
  const DWORD length = SearchPathW(folders.c_str(), wide(name).c_str(), L".exe",
                                   static_cast<DWORD>(found.size()), found.data(), nullptr);
  if (length == 0) {
    throw cannot_run(name, "neither beside mien nor on PATH");
  }
  return {found.data(), length};
}

// Restricts inheritance to these handles, and excludes handles that another thread creates
// meanwhile.
class Inheritance {
 public:
  explicit Inheritance(std::span<HANDLE> handles) {
    SIZE_T bytes = 0;
    InitializeProcThreadAttributeList(nullptr, 1, 0, &bytes);
    memory_.resize(bytes);
    InitializeProcThreadAttributeList(list(), 1, 0, &bytes);
    UpdateProcThreadAttribute(list(), 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, handles.data(),
                              handles.size_bytes(), nullptr, nullptr);
  }
  ~Inheritance() { DeleteProcThreadAttributeList(list()); }
  Inheritance(const Inheritance&) = delete;
  Inheritance& operator=(const Inheritance&) = delete;

  LPPROC_THREAD_ATTRIBUTE_LIST list() {
    return reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(memory_.data());
  }

 private:
  std::vector<std::byte> memory_;
};

// `streams`: the child's standard input, output and error.
Handle spawn(const std::vector<std::string>& arguments, std::array<HANDLE, 3> streams) {
  Inheritance inheritance(streams);
  STARTUPINFOEXW start = {};
  start.StartupInfo.cb = sizeof start;
  start.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
  start.StartupInfo.hStdInput = streams[0];
  start.StartupInfo.hStdOutput = streams[1];
  start.StartupInfo.hStdError = streams[2];
  start.lpAttributeList = inheritance.list();
  const std::wstring program = find_program(arguments[0]);
  std::wstring line = command_line(arguments);
  PROCESS_INFORMATION result = {};
  if (CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE,
                     EXTENDED_STARTUPINFO_PRESENT | CREATE_NO_WINDOW, nullptr, nullptr,
                     &start.StartupInfo, &result) == 0) {
    throw cannot_run(arguments[0], last_error());
  }
  CloseHandle(result.hThread);
  return Handle(result.hProcess);
}

class Win32Child final : public ChildProcess, private Leftover {
 public:
  Win32Child(const std::vector<std::string>& arguments, Pipe pipe);
  ~Win32Child() override {
    if (process_) {
      discard();
      release();
    }
  }
  Win32Child(const Win32Child&) = delete;
  Win32Child& operator=(const Win32Child&) = delete;

  std::optional<std::size_t> read(std::span<std::byte> bytes,
                                  std::chrono::milliseconds timeout) override {
    pipe_.begin_read(bytes);
    return wait_for_pipe(timeout);
  }
  std::optional<std::size_t> write(std::span<const std::byte> bytes,
                                   std::chrono::milliseconds timeout) override {
    pipe_.begin_write(bytes);
    return wait_for_pipe(timeout);
  }
  void close_pipe() override { pipe_.close(); }
  void kill() override { TerminateProcess(process_.get(), kKilled); }
  std::optional<int> wait(std::chrono::milliseconds timeout) override;
  std::string take_errors() override {
    drain_errors();
    return std::exchange(errors_, {});
  }

 private:
  std::optional<std::size_t> wait_for_pipe(std::chrono::milliseconds timeout);
  void collect_errors();
  void drain_errors();
  void discard() noexcept override {
    TerminateProcess(process_.get(), kKilled);
    WaitForSingleObject(process_.get(), INFINITE);
  }
  void release() {
    TerminationLock lock;
    lock.remove(*this);
    process_.reset();
  }

  Handle process_;
  std::array<std::byte, 4096> buffer_{};  // receives errors_pipe_, which is always being read
  PipeEnd pipe_;
  PipeEnd errors_pipe_;
  std::string errors_;
};

Win32Child::Win32Child(const std::vector<std::string>& arguments, Pipe pipe) {
  const bool from_child = pipe == Pipe::kFromChild;
  const Handle data = pipe_.open(from_child);
  const Handle errors = errors_pipe_.open(true);
  const Handle nothing = open_for_child(L"NUL", GENERIC_READ | GENERIC_WRITE);
  TerminationLock lock;
  process_ = from_child ? spawn(arguments, {nothing.get(), data.get(), errors.get()})
                        : spawn(arguments, {data.get(), nothing.get(), errors.get()});
  lock.add(*this);
  errors_pipe_.begin_read(buffer_);
}

// Converts the line ends of Windows.
void Win32Child::collect_errors() {
  errors_.append(reinterpret_cast<const char*>(buffer_.data()), errors_pipe_.moved());
  std::erase(errors_, '\r');
  if (errors_pipe_.open()) {
    errors_pipe_.begin_read(buffer_);
  }
}

// Reads the available bytes.
void Win32Child::drain_errors() {
  while (errors_pipe_.open() && WaitForSingleObject(errors_pipe_.ended(), 0) == WAIT_OBJECT_0) {
    collect_errors();
  }
}

// Pipes end with the child, because other processes that inherited them may live on.
std::optional<std::size_t> Win32Child::wait_for_pipe(std::chrono::milliseconds timeout) {
  const std::array<HANDLE, 3> ends = {pipe_.ended(), process_.get(), errors_pipe_.ended()};
  for (;;) {
    // A negative timeout is INFINITE. Closed ends are excluded, because they never signal.
    const DWORD happened = WaitForMultipleObjects(errors_pipe_.open() ? 3 : 2, ends.data(), FALSE,
                                                  static_cast<DWORD>(timeout.count()));
    if (happened == WAIT_OBJECT_0) {
      return pipe_.moved();
    }
    if (happened == WAIT_OBJECT_0 + 1) {
      if (WaitForSingleObject(pipe_.ended(), 0) == WAIT_OBJECT_0) {
        return pipe_.moved();
      }
      pipe_.cancel();
      return 0;
    }
    if (happened != WAIT_OBJECT_0 + 2) {
      pipe_.cancel();
      return std::nullopt;
    }
    collect_errors();
  }
}

std::optional<int> Win32Child::wait(std::chrono::milliseconds timeout) {
  const std::array<HANDLE, 2> ends = {process_.get(), errors_pipe_.ended()};
  DWORD happened = WAIT_OBJECT_0 + 1;
  while (happened == WAIT_OBJECT_0 + 1) {
    // A negative timeout is INFINITE.
    happened = WaitForMultipleObjects(errors_pipe_.open() ? 2 : 1, ends.data(), FALSE,
                                      static_cast<DWORD>(timeout.count()));
    if (happened == WAIT_OBJECT_0 + 1) {
      collect_errors();
    }
  }
  if (happened == WAIT_TIMEOUT) {
    return std::nullopt;
  }
  drain_errors();
  DWORD status = 0;
  GetExitCodeProcess(process_.get(), &status);
  release();
  return static_cast<int>(status);
}

}  // namespace

std::unique_ptr<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments,
                                                  Pipe pipe) {
  return std::make_unique<Win32Child>(arguments, pipe);
}

}  // namespace mien::app
