// Measures the stack use of custom networks that include/mien/mien.h documents.
#include <gtest/gtest.h>
#include <mien/engine.h>

#include "tests/engine/mini_model.h"
#include "tests/engine/painted_stack.h"

namespace mien::tests {
namespace {

TEST(Stack, IsAsSmallAsTheHeaderSays) {
  AlignedBuffer bytes = mini_file();
  const std::span<const std::byte> file = bytes.span();
  Weights weights;
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t open = stack_of([&] { status = weights.create({&file, 1}); });
  ASSERT_EQ(status, MIEN_OK);
  EXPECT_LT(open, 24u * 1024);
  const WeightsContent content(weights);
  EXPECT_LT(stack_of([&] { (void)content.layer(0, 0); }), 20u * 1024);
  EXPECT_LT(stack_of([&] { (void)content.network(0); }), 96u * 1024);
  for (const char* name : {"encoder", "pnet", "temporal"}) {
    Network network;
    const NetworkConfig config(weights, name);
    const std::size_t create = stack_of([&] { status = network.create(config); });
    ASSERT_EQ(status, MIEN_OK);
    EXPECT_LT(create, 96u * 1024) << name;
    EXPECT_GT(create, 30u * 1024) << "nothing was measured";
    EXPECT_LT(stack_of([&] { network.run(); }), 8u * 1024) << name;
  }
}

}  // namespace
}  // namespace mien::tests
