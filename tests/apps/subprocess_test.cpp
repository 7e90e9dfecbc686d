// Tests of child processes that hang, print too much, or fail.
#include "apps/mien/system/subprocess.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <string>
#include <vector>

namespace mien::app {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
constexpr int kKilled = 128 + SIGKILL;

std::vector<std::string> shell(const std::string& script) { return {"sh", "-c", script}; }

TEST(Subprocess, ReadsTheOutputOfTheChild) {
  Subprocess child(shell("printf abc; sleep 0.1; printf def; printf wrong >&2; exit 3"),
                   Subprocess::Pipe::kFromChild, 60s);
  EXPECT_EQ(child.read_all(), "abcdef");
  EXPECT_EQ(child.finish(), 3);
  EXPECT_EQ(child.take_errors(), "wrong");
}

TEST(Subprocess, ASilentChildIsKilled) {
  const auto began = Clock::now();
  Subprocess child(shell("printf abc; exec sleep 300"), Subprocess::Pipe::kFromChild, 200ms);
  EXPECT_EQ(child.read_all(), "abc");
  EXPECT_EQ(child.finish(), kKilled);
  EXPECT_LT(Clock::now() - began, 100s);
  EXPECT_NE(child.take_errors().find("'sh' was inactive for 0.2"), std::string::npos);
}

TEST(Subprocess, AChildThatReadsNothingIsKilled) {
  const std::vector<std::byte> more_than_a_pipe_holds(1 << 22);
  const auto began = Clock::now();
  Subprocess child(shell("exec sleep 300"), Subprocess::Pipe::kToChild, 200ms);
  EXPECT_FALSE(child.write(more_than_a_pipe_holds));
  EXPECT_EQ(child.finish(), kKilled);
  EXPECT_LT(Clock::now() - began, 100s);
}

TEST(Subprocess, OutputOnStandardErrorBlocksNeitherDirection) {
  const std::string talk = "head -c 300000 /dev/zero | tr '\\0' x >&2; ";
  Subprocess writer(shell(talk + "printf done"), Subprocess::Pipe::kFromChild, 60s);
  EXPECT_EQ(writer.read_all(), "done");
  EXPECT_EQ(writer.finish(), 0);
  EXPECT_EQ(writer.take_errors().size(), 300000u);
  const std::vector<std::byte> much(1 << 20);
  Subprocess reader(shell(talk + "wc -c >&2"), Subprocess::Pipe::kToChild, 60s);
  EXPECT_TRUE(reader.write(much));
  EXPECT_EQ(reader.finish(), 0);
  EXPECT_EQ(reader.take_errors().substr(300000), "1048576\n");
}

TEST(Subprocess, AChildThatClosesStdoutAndContinuesIsKilled) {
  const auto began = Clock::now();
  Subprocess child(shell("printf abc; exec >&-; exec sleep 300"), Subprocess::Pipe::kFromChild,
                   200ms);
  EXPECT_EQ(child.read_all(), "abc");
  EXPECT_EQ(child.finish(), kKilled);
  EXPECT_LT(Clock::now() - began, 100s);
  EXPECT_NE(child.take_errors().find("'sh' was inactive for 0.2"), std::string::npos);
}

// A grandchild that inherited stderr.
TEST(Subprocess, DoesNotWaitForAnotherProcessThatHoldsStderr) {
  const auto began = Clock::now();
  Subprocess child(shell("printf wrong >&2; sleep 30 >/dev/null & exit 3"),
                   Subprocess::Pipe::kFromChild, 60s);
  EXPECT_EQ(child.read_all(), "");
  EXPECT_EQ(child.finish(), 3);
  EXPECT_EQ(child.take_errors(), "wrong");
  EXPECT_LT(Clock::now() - began, 25s);
}

TEST(Subprocess, WritingToAnEndedChildFails) {
  signal(SIGPIPE, SIG_IGN);  // as the program does
  const std::vector<std::byte> much(1 << 22);
  Subprocess child(shell("exit 5"), Subprocess::Pipe::kToChild, 60s);
  EXPECT_FALSE(child.write(much));
  EXPECT_EQ(child.finish(), 5);
}

}  // namespace
}  // namespace mien::app
