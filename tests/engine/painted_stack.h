// Measures the use of the stack: runs work on a thread whose stack is filled with a pattern.
#pragma once

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <span>
#include <utility>

namespace mien::tests {

inline constexpr std::size_t kPaintedBytes = 256 * 1024;
inline constexpr std::byte kPaint{0xA5};

inline void* call_work(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

// The number of bytes from the top of the stack to the lowest one that was written.
inline std::size_t touched(std::function<void()> work) {
  const std::unique_ptr<void, void (*)(void*)> memory(std::aligned_alloc(4096, kPaintedBytes),
                                                      std::free);
  const std::span stack(static_cast<std::byte*>(memory.get()), kPaintedBytes);
  std::ranges::fill(stack, kPaint);
  pthread_attr_t attributes;
  pthread_t thread;
  EXPECT_EQ(pthread_attr_init(&attributes), 0);
  EXPECT_EQ(pthread_attr_setstack(&attributes, stack.data(), stack.size()), 0);
  EXPECT_EQ(pthread_create(&thread, &attributes, call_work, &work), 0);
  EXPECT_EQ(pthread_join(thread, nullptr), 0);
  EXPECT_EQ(pthread_attr_destroy(&attributes), 0);
  const auto deepest = std::ranges::find_if(stack, [](std::byte b) { return b != kPaint; });
  return static_cast<std::size_t>(stack.end() - deepest);
}

// Excludes the stack use of an empty thread.
inline std::size_t stack_of(std::function<void()> work) {
  return touched(std::move(work)) - touched([] {});
}

}  // namespace mien::tests
