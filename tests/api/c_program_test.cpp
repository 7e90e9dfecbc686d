// Runs c_program.c.
#include <gtest/gtest.h>

extern "C" int mien_c_program(void);

TEST(CProgram, CompilesLinksAndRuns) { EXPECT_EQ(mien_c_program(), 0); }
