// Tests of golden files: both readers accept or reject them, and both writers write the same bytes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/formats/description.h"
#include "tests/formats/files.h"

namespace mien::formats {
namespace {

// Output of the second reader: file -> status and description.
std::map<std::string, std::string> second_reader(const std::string& folder) {
  const std::string output = output_of(std::string(kPython) + " " + golden_folder() +
                                       "second_reader.py " + golden_folder() + folder + "/*.mien");
  std::map<std::string, std::string> found;
  std::istringstream lines(output);
  std::string current;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) {
      found[current] += line.substr(2) + "\n";
    } else {
      current = line.substr(0, line.find(' '));
      found[current] = line.substr(line.find(' ') + 1) + "\n";
    }
  }
  return found;
}

TEST(GoldenFiles, AreAccepted) {
  const auto files = files_in(golden_folder() + "accept", ".mien");
  ASSERT_GE(files.size(), 4u);
  for (const std::string& path : files) {
    EXPECT_EQ(status_name(open_copy(read_file(path)).status), "kOk") << path;
  }
}

TEST(GoldenFiles, AreRejectedForTheRightReasonAtTheRightOffset) {
  std::ifstream expected(golden_folder() + "reject/expected.txt");
  std::set<std::string> statuses;
  std::size_t count = 0;
  std::string name, status;
  for (std::uint64_t offset; expected >> name >> status >> offset; ++count) {
    const mien_error_detail validation = open_copy(read_file(golden_folder() + "reject/" + name));
    EXPECT_EQ(status_name(validation.status), status) << name;
    EXPECT_EQ(validation.offset, offset) << name;
    statuses.insert(status);
  }
  EXPECT_EQ(count, files_in(golden_folder() + "reject", ".mien").size());
  // All statuses except kOk and kMisaligned, which no file can cause.
  std::set<std::string> all;
  for (int i = -150; i <= 0; ++i) {
    all.insert(status_name(i));
  }
  for (const char* other : {"", "kOk", "kMisaligned"}) {
    all.erase(other);
  }
  EXPECT_EQ(statuses, all);
}

TEST(GoldenFiles, SecondReaderAgreesOnAllAcceptedFiles) {
  if (!std::filesystem::exists(kPython)) {
    GTEST_SKIP() << "no " << kPython;
  }
  const auto second = second_reader("accept");
  for (const std::string& path : files_in(golden_folder() + "accept", ".mien")) {
    const std::vector<std::byte> file = read_file(path);
    AlignedBytes bytes(file);
    FileView view;
    ASSERT_EQ(open(bytes.get(), view).status, MIEN_OK);
    EXPECT_EQ(second.at(name_of(path)), "kOk\n" + described(view)) << path;
  }
}

TEST(GoldenFiles, SecondReaderAgreesOnAllRejectedFiles) {
  if (!std::filesystem::exists(kPython)) {
    GTEST_SKIP() << "no " << kPython;
  }
  const auto second = second_reader("reject");
  for (const std::string& path : files_in(golden_folder() + "reject", ".mien")) {
    const auto status = static_cast<mien_status>(open_copy(read_file(path)).status);
    EXPECT_EQ(second.at(name_of(path)), status_name(status) + "\n") << path;
  }
}

TEST(Writers, CppWritesTheGoldenBytes) {
  const auto descriptions = files_in(golden_folder() + "descriptions", ".json");
  ASSERT_EQ(descriptions.size(), files_in(golden_folder() + "accept", ".mien").size());
  for (const std::string& path : descriptions) {
    std::vector<std::byte> file;
    EXPECT_EQ(status_name(write_described(path, &file).status), "kOk") << path;
    const std::string stem = std::filesystem::path(path).stem().string();
    EXPECT_TRUE(file == read_file(golden_folder() + "accept/" + stem + ".mien")) << path;
  }
}

TEST(Writers, PythonWritesTheGoldenBytes) {
  if (!std::filesystem::exists(kPython)) {
    GTEST_SKIP() << "no " << kPython;
  }
  for (const std::string& path : files_in(golden_folder() + "descriptions", ".json")) {
    const std::string stem = std::filesystem::path(path).stem().string();
    const std::string written = testing::TempDir() + "mien_" + stem + ".mien";
    output_of(std::string(kPythonCommand) + golden_folder() + "describe.py " + path + " " +
              written);
    EXPECT_TRUE(read_file(written) == read_file(golden_folder() + "accept/" + stem + ".mien"));
    std::filesystem::remove(written);
  }
}

TEST(Writers, PythonWriterPassesItsOwnTests) {
  if (!std::filesystem::exists(kPython)) {
    GTEST_SKIP() << "no " << kPython;
  }
  output_of(std::string(kPythonCommand) + MIEN_SOURCE_DIR "/tests/formats/mien_file_test.py 2>&1");
}

}  // namespace
}  // namespace mien::formats
