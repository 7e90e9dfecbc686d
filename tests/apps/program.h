// Runs the program like a user.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace mien::tests {

namespace fs = std::filesystem;

inline const std::string kSource = MIEN_SOURCE_DIR;
inline const std::string kClip = kSource + "/tests/data/demo.mp4";

struct Outcome {
  int code;
  std::string output, errors;
};

inline std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("mien_" + std::string(test->test_suite_name()) + "_" + test->name() + "_" +
               std::to_string(getpid()));  // two builds may be tested at once
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome run(const std::string& arguments, const std::string& environment = "",
              const std::string& input = "/dev/null") const {
    const std::string out = path("stdout"), err = path("stderr");
    const std::string command = environment + " '" + MIEN_PROGRAM + "' " + arguments + " >" + out +
                                " 2>" + err + " <" + input;
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), contents(out), contents(err)};
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string models() const { return " --models " + kSource + "/models"; }

  static bool have_ffmpeg() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }
  static bool have_models() { return fs::exists(kSource + "/models/basenet.mien"); }

  fs::path folder_;
};

#define MIEN_NEEDS(what, condition) \
  if (!(condition)) GTEST_SKIP() << "skipped: missing: " what

inline std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace mien::tests
