// Runs the functions that camera and audio threads call under clang's real-time sanitizer, which
// ends the process at the first call of a function that may block; it knows some hundred of the C
// library.
// Source: https://clang.llvm.org/docs/RealtimeSanitizer.html
#include <gtest/gtest.h>

#include <mutex>

#include "tests/realtime/stage.h"

namespace mien::tests {
namespace {

template <class Work>
bool in_real_time(Work work) [[clang::nonblocking]] {
  return work();
}

TEST(RealtimeSanitizer, NoticesALock) {
  std::mutex mutex;
  const auto lock = [&] {
    const std::lock_guard locked(mutex);
    return true;
  };
  EXPECT_DEATH(in_real_time(lock), "unsafe-library-call");
}

TEST(RealtimeSanitizer, FindsNothing) {
  for (const std::int32_t faces : {1, 3}) {
    Stage stage(faces);
    EXPECT_TRUE(in_real_time([&] { return stage.play(); }));
  }
}

}  // namespace
}  // namespace mien::tests
