// Tests that an output cannot be an input under any name or link.
#include "apps/mien/outputs/distinct_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

class DistinctFiles : public testing::Test {
 protected:
  DistinctFiles() {
    fs::create_directories(folder_ / "below");
    std::ofstream(path("a")) << "a";
    std::ofstream(path("b")) << "a";
    fs::create_symlink(path("a"), path("link"));
    fs::create_symlink(path("link"), path("link_to_link"));
    fs::create_hard_link(path("a"), path("hard"));
    fs::create_directory_symlink(folder_, path("below/up"));
  }
  ~DistinctFiles() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  bool rejected(const std::string& input, const std::string& output) const {
    try {
      require_distinct_files({path("b"), "", input}, {"", path("new"), output});
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), kExitUsage);
      EXPECT_EQ(failure.what(), output + ": the output is the same file as the input " + input);
      return true;
    }
    return false;
  }

  fs::path folder_ = fs::temp_directory_path() / ("mien_distinct_" + std::to_string(getpid()));
};

TEST_F(DistinctFiles, RejectsTheSameFileUnderAnyName) {
  for (const char* name : {"a", "./below/../a", "link", "link_to_link", "hard", "below/up/a"}) {
    EXPECT_TRUE(rejected(path("a"), path(name))) << name;
    EXPECT_TRUE(rejected(path(name), path("a"))) << name;
  }
  EXPECT_TRUE(rejected(path("a"), fs::relative(path("a")).string()));
}

TEST_F(DistinctFiles, AcceptsOtherFilesWithTheSameContent) {
  EXPECT_FALSE(rejected(path("a"), path("b.csv")));
  EXPECT_FALSE(rejected(path("a"), path("below/a")));
  EXPECT_FALSE(rejected("rtsp://camera/a", path("a")));
  EXPECT_FALSE(rejected(path("not there"), path("not there")));
}

TEST_F(DistinctFiles, ADeviceMayBeInputAndOutput) {
  EXPECT_FALSE(rejected("/dev/null", "/dev/null"));
}

}  // namespace
}  // namespace mien::app
