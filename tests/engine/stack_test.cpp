// What include/mien/engine.h says about the stack, measured: work is done by a thread whose stack
// was painted before.
#include <gtest/gtest.h>
#include <mien/engine.h>
#include <pthread.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "tests/engine/mini_model.h"

namespace mien::tests {
namespace {

constexpr std::size_t kStackBytes = 256 * 1024;
constexpr std::byte kPaint{0xA5};

void* call(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

// Bytes from the top of the stack to the deepest that was written to.
std::size_t touched(std::function<void()> work) {
  AlignedBuffer stack(kStackBytes);
  std::fill(stack.span().begin(), stack.span().end(), kPaint);
  pthread_attr_t attributes;
  pthread_t thread;
  EXPECT_EQ(pthread_attr_init(&attributes), 0);
  EXPECT_EQ(pthread_attr_setstack(&attributes, stack.span().data(), kStackBytes), 0);
  EXPECT_EQ(pthread_create(&thread, &attributes, call, &work), 0);
  EXPECT_EQ(pthread_join(thread, nullptr), 0);
  EXPECT_EQ(pthread_attr_destroy(&attributes), 0);
  const auto deepest = std::find_if(stack.span().begin(), stack.span().end(),
                                    [](std::byte b) { return b != kPaint; });
  return static_cast<std::size_t>(stack.span().end() - deepest);
}

// Without what a thread takes that does nothing.
std::size_t stack_of(std::function<void()> work) {
  return touched(std::move(work)) - touched([] {});
}

TEST(Stack, IsAsSmallAsTheHeaderSays) {
  AlignedBuffer bytes = mini_file();
  WeightFile file;
  EngineStatus opened = EngineStatus::kBadFile, made = EngineStatus::kBadFile;
  const std::size_t open = stack_of([&] { opened = file.open(bytes.span()); });
  ASSERT_EQ(opened, EngineStatus::kOk);
  EXPECT_LT(open, 20u * 1024);
  EXPECT_LT(stack_of([&] { (void)file.layer(0, 0); }), 20u * 1024);
  EXPECT_LT(stack_of([&] { (void)file.network(0); }), 80u * 1024);
  for (const char* network : {"encoder", "pnet", "temporal"}) {
    NetworkRunner runner;
    const std::size_t create = stack_of([&] { made = runner.create(file, network); });
    ASSERT_EQ(made, EngineStatus::kOk);
    EXPECT_LT(create, 80u * 1024) << network;
    EXPECT_GT(create, 30u * 1024) << "nothing was measured";
    EXPECT_LT(stack_of([&] { runner.run(); }), 8u * 1024) << network;
  }
}

}  // namespace
}  // namespace mien::tests
