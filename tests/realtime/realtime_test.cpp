// What a thread of a camera or a sound card calls allocates nothing, locks nothing, throws nothing
// and asks the system for nothing.
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

TEST(Realtime, ForbiddenCallsAreNoticed) {
  std::mutex mutex;
  ForbiddenCalls calls;
  { const std::lock_guard lock(mutex); }
  // Through a volatile pointer, or the compiler leaves the pair of calls out.
  int* volatile made = new int(1);
  delete made;
  const std::vector<std::string> noticed = calls.stop();
  EXPECT_EQ(noticed, (std::vector<std::string>{"pthread_mutex_lock", "pthread_mutex_unlock",
                                               "malloc", "free"}));
}

TEST(Realtime, NothingForbiddenIsCalled) {
  for (const std::int32_t faces : {1, 3}) {
    Stage stage(faces);
    ForbiddenCalls calls;
    const bool right = stage.play();
    const std::vector<std::string> noticed = calls.stop();
    EXPECT_EQ(noticed, std::vector<std::string>());
    EXPECT_TRUE(right);
  }
}

// 0: none was made; 1: one was; 77: cannot be told here.
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
  const auto asks = [] { return getppid() > 0; };
  const int noticed = exit_status_without_system_calls(asks);
  if (noticed == 77) {
    GTEST_SKIP() << "skipped: no seccomp here";
  }
  EXPECT_EQ(noticed, 1) << "a system call has to be noticed";
  Stage stage(1);
  EXPECT_EQ(exit_status_without_system_calls([&] { return stage.play(); }), 0);
}

}  // namespace
}  // namespace mien::tests
