// Catches crashes with signals or structured exceptions.
#include "apps/conformance/crash_guard.h"

#include <cfenv>

#if defined(_WIN32)
#include <windows.h>
#elif !defined(__wasm__)
#include <setjmp.h>
#include <signal.h>

#include <iterator>
#include <memory>
#endif

namespace mien::conformance {

#if defined(_WIN32)

namespace {

thread_local CONTEXT* way_back = nullptr;
thread_local const char* volatile cause = nullptr;

const char* name_of(DWORD code) {
  switch (code) {
    case EXCEPTION_ACCESS_VIOLATION:
      return "access violation: invalid memory access";
    case EXCEPTION_ILLEGAL_INSTRUCTION:
    case EXCEPTION_PRIV_INSTRUCTION:
      return "illegal instruction";
    case EXCEPTION_DATATYPE_MISALIGNMENT:
      return "misaligned access";
    case EXCEPTION_INT_DIVIDE_BY_ZERO:
      return "integer division by zero";
    case EXCEPTION_STACK_OVERFLOW:
      return "stack overflow";
    case EXCEPTION_BREAKPOINT:
      return "breakpoint";
    default:
      return nullptr;
  }
}

// Resumes where run_guarded saved its registers.
LONG CALLBACK on_exception(EXCEPTION_POINTERS* pointers) {
  const char* known = name_of(pointers->ExceptionRecord->ExceptionCode);
  if (known == nullptr || way_back == nullptr) {
    return EXCEPTION_CONTINUE_SEARCH;
  }
  cause = known;
  *pointers->ContextRecord = *way_back;
  return EXCEPTION_CONTINUE_EXECUTION;
}

}  // namespace

bool can_catch_crashes() { return true; }

const char* run_guarded(void (*body)(void*), void* context) {
  static void* const handler = AddVectoredExceptionHandler(1, on_exception);
  static_cast<void>(handler);
  std::fenv_t environment;
  std::fegetenv(&environment);
  CONTEXT here;
  cause = nullptr;
  RtlCaptureContext(&here);
  if (cause == nullptr) {  // before or without a crash
    way_back = &here;
    body(context);
  }
  way_back = nullptr;
  if (cause != nullptr) {
    std::fesetenv(&environment);
  }
  return cause;
}

#elif defined(__wasm__)

bool can_catch_crashes() { return false; }

const char* run_guarded(void (*body)(void*), void* context) {
  body(context);
  return nullptr;
}

#else

namespace {

constexpr int kSignals[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGTRAP, SIGABRT};
constexpr std::size_t kStackBytes = std::size_t{64} * 1024;

thread_local sigjmp_buf way_back;
thread_local volatile sig_atomic_t guarded = 0;

void on_signal(int number) {
  if (guarded == 0) {  // a crash of this program itself: default handling
    signal(number, SIG_DFL);
    raise(number);
    return;
  }
  siglongjmp(way_back, number);
}

const char* name_of(int number) {
  switch (number) {
    case SIGSEGV:
      return "SIGSEGV: invalid memory access";
    case SIGBUS:
      return "SIGBUS: unmapped or misaligned memory access";
    case SIGILL:
      return "SIGILL: illegal instruction";
    case SIGFPE:
      return "SIGFPE: arithmetic exception";
    case SIGTRAP:
      return "SIGTRAP: trap";
    case SIGABRT:
      return "SIGABRT: aborts";
    default:
      return "signal";
  }
}

// Installs handlers, on a stack of their own because a kernel may have corrupted its stack, and
// only while needed because sanitizers also have handlers.
class Handlers {
 public:
  Handlers() : stack_(std::make_unique<char[]>(kStackBytes)) {
    stack_t stack{};
    stack.ss_sp = stack_.get();
    stack.ss_size = kStackBytes;
    sigaltstack(&stack, &old_stack_);
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_ONSTACK | SA_NODEFER;
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
      sigaction(kSignals[i], &action, &old_[i]);
    }
  }
  ~Handlers() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
      sigaction(kSignals[i], &old_[i], nullptr);
    }
    sigaltstack(&old_stack_, nullptr);
  }
  Handlers(const Handlers&) = delete;
  Handlers& operator=(const Handlers&) = delete;

 private:
  std::unique_ptr<char[]> stack_;
  stack_t old_stack_{};
  struct sigaction old_[std::size(kSignals)]{};
};

}  // namespace

bool can_catch_crashes() { return true; }

const char* run_guarded(void (*body)(void*), void* context) {
  const Handlers handlers;
  std::fenv_t environment;
  std::fegetenv(&environment);
  const int number = sigsetjmp(way_back, 1);
  if (number != 0) {
    guarded = 0;
    std::fesetenv(&environment);
    return name_of(number);
  }
  guarded = 1;
  body(context);
  guarded = 0;
  return nullptr;
}

#endif

}  // namespace mien::conformance
