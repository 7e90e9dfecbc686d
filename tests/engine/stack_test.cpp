// Measures the stack use that include/mien/engine.h documents.
#include <gtest/gtest.h>
#include <mien/engine.h>

#include "tests/engine/mini_model.h"
#include "tests/engine/painted_stack.h"

namespace mien::tests {
namespace {

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
