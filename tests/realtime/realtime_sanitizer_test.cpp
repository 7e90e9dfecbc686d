// What a thread of a camera or a sound card calls, under clang's real-time sanitizer, which knows
// some hundred functions of the C library that may block and ends the process at the first one.
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
