// These functions are defined in the program, where the dynamic linker finds them before those of
// the C library.
#include "tests/realtime/forbidden_calls.h"

#include <dlfcn.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cxxabi.h>
#include <array>
#include <atomic>
#include <clocale>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace {

std::atomic<bool> noting = false;
std::atomic<std::size_t> noted = 0;
std::array<const char*, 64> names;

void note(const char* name) {
  if (noting) {
    const std::size_t i = noted++;
    if (i < names.size()) {
      names[i] = name;
    }
  }
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

// glibc's internal names of the heap functions.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void* memory);

void* malloc(std::size_t bytes) {
  note("malloc");
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  note("calloc");
  return __libc_calloc(count, bytes);
}
void* realloc(void* memory, std::size_t bytes) {
  note("realloc");
  return __libc_realloc(memory, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  note("aligned_alloc");
  return __libc_memalign(alignment, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
  note("memalign");
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  note("posix_memalign");
  *memory = __libc_memalign(alignment, bytes);
  return *memory != nullptr ? 0 : 12;
}
void free(void* memory) {
  note("free");
  __libc_free(memory);
}

// Looks up the real function at the first call. The constant initialization of the pointer needs no
// guard. The C library does not declare cancellation points noexcept, and clang requires the same
// declaration here.
#define MIEN_FORBID(Result, name, Parameters, ...) \
  MIEN_FORBID_AS(Result, name, Parameters, noexcept, __VA_ARGS__)
#define MIEN_FORBID_AS(Result, name, Parameters, promise, ...) \
  Result name Parameters promise {                             \
    static Result(*real) Parameters = nullptr;                 \
    if (real == nullptr) {                                     \
      real = next<Result Parameters>(#name);                   \
    }                                                          \
    note(#name);                                               \
    return real(__VA_ARGS__);                                  \
  }
MIEN_FORBID(int, pthread_mutex_lock, (pthread_mutex_t * it), it)
MIEN_FORBID(int, pthread_mutex_trylock, (pthread_mutex_t * it), it)
MIEN_FORBID(int, pthread_mutex_unlock, (pthread_mutex_t * it), it)
MIEN_FORBID(int, pthread_rwlock_rdlock, (pthread_rwlock_t * it), it)
MIEN_FORBID(int, pthread_rwlock_wrlock, (pthread_rwlock_t * it), it)
MIEN_FORBID(int, pthread_cond_signal, (pthread_cond_t * it), it)
MIEN_FORBID(int, pthread_cond_broadcast, (pthread_cond_t * it), it)
MIEN_FORBID(int, pthread_spin_lock, (pthread_spinlock_t * it), it)
MIEN_FORBID(int, sem_post, (sem_t * it), it)
MIEN_FORBID_AS(int, fflush, (std::FILE * it), , it)
MIEN_FORBID(char*, getenv, (const char* it), it)
MIEN_FORBID(char*, setlocale, (int category, const char* locale), category, locale)
MIEN_FORBID(void*, __cxa_allocate_exception, (std::size_t bytes), bytes)
#undef MIEN_FORBID_AS
#undef MIEN_FORBID

// The guard of a static local variable, at its first use.
int __cxa_guard_acquire(__cxxabiv1::__guard* guard) {
  static int (*real)(__cxxabiv1::__guard*) =
      nullptr;  // constant initialization, which needs no guard
  if (real == nullptr) {
    real = next<int(__cxxabiv1::__guard*)>("__cxa_guard_acquire");
  }
  note("__cxa_guard_acquire");
  return real(guard);
}
}

namespace mien::tests {

ForbiddenCalls::ForbiddenCalls() {
  noted = 0;
  noting = true;
}

ForbiddenCalls::~ForbiddenCalls() { noting = false; }

std::vector<std::string> ForbiddenCalls::stop() {
  noting = false;
  const std::size_t count = noted < names.size() ? noted.load() : names.size();
  return {names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count)};
}

bool forbid_system_calls() {
  struct sigaction action {};
  action.sa_flags = SA_SIGINFO;
  action.sa_sigaction = [](int, siginfo_t* info, void*) {
    char text[64];
    const int length = std::snprintf(text, sizeof text, "system call %d\n", info->si_syscall);
    (void)!write(STDERR_FILENO, text, static_cast<std::size_t>(length));
    _exit(1);
  };
  sigaction(SIGSYS, &action, nullptr);
  constexpr auto kNumber = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kNumber),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_write, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter = {static_cast<unsigned short>(std::size(program)), program};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

}  // namespace mien::tests
