// Tests of output files: they appear complete, and each has one writer.
#include "apps/mien/outputs/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
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
    EXPECT_EQ(failure.what(), path + ": duplicate output path");
    return true;
  }
  return false;
}

TEST_F(OutputFiles, RejectsASecondOutputToTheSameFileUnderAnyName) {
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

// Replaces the link, not its target.
TEST_F(OutputFiles, ALinkToAFileIsADifferentOutput) {
  std::ofstream(path("a")) << "before";
  fs::create_symlink(path("a"), path("b"));
  const OutputFile first(path("a"));
  EXPECT_FALSE(refused(path("b")));
}

TEST_F(OutputFiles, WritesToDevices) {
  const OutputFile first("/dev/null");
  EXPECT_FALSE(refused("/dev/null"));
}

TEST_F(OutputFiles, AFailedPublicationLeavesNothing) {
  {
    OutputFile file(path("below"));
    EXPECT_THROW(file.finish(), Failure);
  }
  EXPECT_EQ(files(), std::vector<std::string>());
}

mode_t mode_of(const std::string& path) {
  struct stat found = {};
  return stat(path.c_str(), &found) == 0 ? found.st_mode & 07777 : 0;
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// With a nameless and a named temporary file.
constexpr TemporaryFile::Ending kEndings[] = {TemporaryFile::Ending::kAny,
                                              TemporaryFile::Ending::kOfDestination};

void write_file(const std::string& path, TemporaryFile::Ending ending) {
  PartialFile file(path, ending);
  std::FILE* stream = file.open();
  ASSERT_NE(stream, nullptr);
  std::fputs("after", stream);
  std::fclose(stream);
  file.publish();
}

TEST_F(OutputFiles, KeepTheModeOfAFileTheyReplace) {
  for (const TemporaryFile::Ending ending : kEndings) {
    for (const mode_t mode : {0600U, 0640U, 0664U, 0755U, 0400U}) {
      std::ofstream(path("a")) << "before";
      chmod(path("a").c_str(), mode);
      write_file(path("a"), ending);
      EXPECT_EQ(mode_of(path("a")), mode);
      EXPECT_EQ(contents(path("a")), "after");
      fs::remove(path("a"));
    }
  }
}

TEST_F(OutputFiles, KeepTheOwnerOfAFileTheyReplace) {
  if (geteuid() != 0) {
    GTEST_SKIP() << "only root can give a file away";
  }
  for (const TemporaryFile::Ending ending : kEndings) {
    std::ofstream(path("a")) << "before";
    ASSERT_EQ(chown(path("a").c_str(), 12345, 23456), 0);
    write_file(path("a"), ending);
    struct stat found = {};
    ASSERT_EQ(stat(path("a").c_str(), &found), 0);
    EXPECT_EQ(found.st_uid, 12345U);
    EXPECT_EQ(found.st_gid, 23456U);
    fs::remove(path("a"));
  }
}

TEST_F(OutputFiles, NewFilesHaveTheDefaultMode) {
  const mode_t before = umask(027);
  for (const TemporaryFile::Ending ending : kEndings) {
    write_file(path("a"), ending);
    EXPECT_EQ(mode_of(path("a")), 0640U);
    fs::remove(path("a"));
  }
  umask(before);
}

// The new file must not be readable earlier than allowed for the replaced file.
TEST_F(OutputFiles, APrivateFileIsPrivateWhileItIsReplaced) {
  std::ofstream(path("a")) << "before";
  chmod(path("a").c_str(), 0600);
  for (const TemporaryFile::Ending ending : kEndings) {
    const PartialFile file(path("a"), ending);
    EXPECT_EQ(mode_of(file.name()), 0600U);
  }
}

TEST_F(OutputFiles, TemporaryNamesAreUnpredictableAndInTheSameFolder) {
  std::set<std::string> names;
  for (int i = 0; i < 100; ++i) {
    const PartialFile file(path("below/a.webm"), TemporaryFile::Ending::kOfDestination);
    const fs::path name(file.name());
    EXPECT_EQ(name.parent_path(), folder_ / "below");
    EXPECT_EQ(name.extension(), ".webm");
    EXPECT_TRUE(names.insert(name.filename().string()).second) << name;
    EXPECT_GE(name.stem().string().size(), 24U);
  }
  EXPECT_EQ(files(), std::vector<std::string>());
}

TEST_F(OutputFiles, NamesMayBeAsLongAsTheFileSystemAllows) {
  const std::string longest(255, 'a');
  for (const TemporaryFile::Ending ending : kEndings) {
    write_file(path(longest), ending);
    EXPECT_EQ(contents(path(longest)), "after");
  }
}

TEST_F(OutputFiles, ALinkInTheirPlaceIsReplaced) {
  for (const TemporaryFile::Ending ending : kEndings) {
    std::ofstream(path("victim")) << "before";
    fs::create_symlink(path("victim"), path("a"));
    write_file(path("a"), ending);
    EXPECT_EQ(contents(path("victim")), "before");
    EXPECT_FALSE(fs::is_symlink(path("a")));
    EXPECT_EQ(contents(path("a")), "after");
    fs::remove(path("a"));
  }
}

// Another program replaced the temporary file, possibly one of another user.
TEST_F(OutputFiles, AnExchangedTemporaryFileIsNotPublished) {
  {
    PartialFile file(path("a"), TemporaryFile::Ending::kOfDestination);
    fs::remove(file.name());
    std::ofstream(path("victim")) << "before";
    fs::create_symlink(path("victim"), file.name());
    EXPECT_THROW(file.publish(), Failure);
  }
  EXPECT_FALSE(fs::exists(path("a")));
  EXPECT_EQ(contents(path("victim")), "before");
}

// Replacing /dev/stdout would destroy that name for all programs.
TEST_F(OutputFiles, NamesOfOpenFilesAreWrittenTo) {
  std::ofstream(path("a")) << "before";
  std::FILE* const opened = std::fopen(path("a").c_str(), "r+");
  ASSERT_NE(opened, nullptr);
  const std::string name = "/dev/fd/" + std::to_string(fileno(opened));
  OutputFile file(name);
  file.write("after");
  file.finish();
  EXPECT_TRUE(fs::is_symlink(name));
  std::fclose(opened);
  EXPECT_EQ(contents(path("a")), "after");
}

TEST_F(OutputFiles, OnlyOneThreadCanWriteAFile) {
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
