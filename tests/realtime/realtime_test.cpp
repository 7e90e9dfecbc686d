// The functions that camera and audio threads call do not allocate, lock, throw or make system
// calls.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <mutex>
#include <string>
#include <vector>

#include "tests/realtime/forbidden_calls.h"
#include "tests/realtime/stage.h"

namespace mien::tests {
namespace {

TEST(Realtime, ForbiddenCallsAreDetected) {
  std::mutex mutex;
  ForbiddenCalls calls;
  { const std::lock_guard lock(mutex); }
  // Volatile, so that the compiler does not remove the pair of calls.
  int* volatile made = new int(1);
  delete made;
  const std::vector<std::string> detected = calls.stop();
  EXPECT_EQ(detected, (std::vector<std::string>{"pthread_mutex_lock", "pthread_mutex_unlock",
                                                "malloc", "free"}));
}

TEST(Realtime, NothingForbiddenIsCalled) {
  for (const std::int32_t faces : {1, 3}) {
    Stage stage(faces);
    ForbiddenCalls calls;
    const bool accepted = stage.play();
    const std::vector<std::string> detected = calls.stop();
    EXPECT_EQ(detected, std::vector<std::string>());
    EXPECT_TRUE(accepted);
  }
}

// Returns 0 if no system call was made, 1 if one was, 77 if the kernel cannot detect them.
template <class Work>
int exit_status_without_system_calls(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    if (!forbid_system_calls()) {
      _exit(77);
    }
    _exit(work() ? 0 : 2);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

TEST(Realtime, NoSystemCallIsMade) {
  const auto system_call = [] { return getppid() > 0; };
  const int detected = exit_status_without_system_calls(system_call);
  if (detected == 77) {
    GTEST_SKIP() << "skipped: seccomp is not available";
  }
  EXPECT_EQ(detected, 1) << "a system call must be detected";
  Stage stage(1);
  EXPECT_EQ(exit_status_without_system_calls([&] { return stage.play(); }), 0);
}

}  // namespace
}  // namespace mien::tests
