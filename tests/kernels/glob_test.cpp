// Tests of the patterns that select kernels by name.
#include "apps/conformance/glob.h"

#include <gtest/gtest.h>

namespace mien::tests {
namespace {

using conformance::matches;

TEST(Glob, StarsAndQuestionMarks) {
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("*", "pointwise"));
  EXPECT_TRUE(matches("point*", "pointwise"));
  EXPECT_TRUE(matches("*wise", "depthwise"));
  EXPECT_TRUE(matches("*pool*", "max_pool_x"));
  EXPECT_TRUE(matches("?stm", "lstm"));
  EXPECT_TRUE(matches("network/*_encoder", "network/basenet_encoder"));
  EXPECT_TRUE(matches("a*b*c", "a_b_b_c"));
  EXPECT_FALSE(matches("", "lstm"));
  EXPECT_FALSE(matches("lst", "lstm"));
  EXPECT_FALSE(matches("?", "lstm"));
  EXPECT_FALSE(matches("*wis", "pointwise"));
  EXPECT_FALSE(matches("a*b*c", "a_b_b_"));
}

}  // namespace
}  // namespace mien::tests
