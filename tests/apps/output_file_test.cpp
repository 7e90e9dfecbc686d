// Files that appear whole, and of which no two are written at once.
#include "apps/mien/outputs/output_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

class OutputFiles : public testing::Test {
 protected:
  OutputFiles() {
    fs::create_directories(folder_ / "below");
    fs::create_directory_symlink(folder_ / "below", folder_ / "link");
  }
  ~OutputFiles() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) {
        names.push_back(entry.path().filename().string());
      }
    }
    return names;
  }

  fs::path folder_ = fs::temp_directory_path() / ("mien_outputs_" + std::to_string(getpid()));
};

bool refused(const std::string& path) {
  try {
    const OutputFile second(path);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), kExitUsage);
    EXPECT_EQ(failure.what(), path + ": is to be written twice");
    return true;
  }
  return false;
}

TEST_F(OutputFiles, OneOfAFileAtOnceWhateverItIsCalled) {
  {
    OutputFile first(path("below/a"));
    EXPECT_TRUE(refused(path("below/a")));
    EXPECT_TRUE(refused(path("./below/../below/a")));
    EXPECT_TRUE(refused(path("link/a")));
    EXPECT_TRUE(refused(fs::relative(path("below/a")).string()));
    EXPECT_FALSE(refused(path("a")));
    first.write("whole");
    first.finish();
    EXPECT_TRUE(refused(path("below/a"))) << "it would be replaced";
  }
  EXPECT_EQ(files(), std::vector<std::string>{"a"});
  EXPECT_FALSE(refused(path("below/a")));
  EXPECT_EQ(files(), std::vector<std::string>{"a"});
}

// What is replaced is the link, not what it leads to.
TEST_F(OutputFiles, ALinkToAFileIsAnother) {
  std::ofstream(path("a")) << "before";
  fs::create_symlink(path("a"), path("b"));
  const OutputFile first(path("a"));
  EXPECT_FALSE(refused(path("b")));
}

TEST_F(OutputFiles, DevicesTakeWhatComes) {
  const OutputFile first("/dev/null");
  EXPECT_FALSE(refused("/dev/null"));
}

TEST_F(OutputFiles, OneThatCannotBePublishedLeavesNothing) {
  {
    OutputFile file(path("below"));
    EXPECT_THROW(file.finish(), Failure);
  }
  EXPECT_EQ(files(), std::vector<std::string>());
}

TEST_F(OutputFiles, ThreadsGetOneOfAFileToo) {
  std::atomic<int> open = 0, most = 0, written = 0;
  const auto write = [&] {
    for (int i = 0; i < 200; ++i) {
      try {
        OutputFile file(path("a"));
        most = std::max(most.load(), ++open);
        file.finish();
        ++written;
        --open;
      } catch (const Failure&) {
        continue;
      }
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back(write);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(most, 1);
  EXPECT_GT(written, 0);
}

}  // namespace
}  // namespace mien::app
