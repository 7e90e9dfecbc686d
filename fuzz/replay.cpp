// Runs a fuzz target over all files of folders, without libFuzzer. usage: replay_NAME FOLDER...
#include <dirent.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "fuzz/target.h"

namespace {

void replay(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  std::vector<std::uint8_t> read;
  for (int byte = 0; file && (byte = std::fgetc(file.get())) != EOF;) {
    read.push_back(static_cast<std::uint8_t>(byte));
  }
  // In memory of its exact size, so that the sanitizer detects every read beyond it.
  const std::vector<std::uint8_t> bytes(read.begin(), read.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

// Returns the number of files. Uses the C library, because the memory sanitizer does not see the
// writes of std::filesystem and streams inside the C++ library.
std::size_t replay_folder(const std::string& folder) {
  const std::unique_ptr<DIR, int (*)(DIR*)> files(opendir(folder.c_str()), &closedir);
  std::size_t count = 0;
  while (const dirent* file = files ? readdir(files.get()) : nullptr) {
    if (file->d_name[0] != '.') {
      replay(folder + "/" + file->d_name);
      ++count;
    }
  }
  return count;
}

}  // namespace

int main(int count, char** arguments) {
  std::size_t files = 0;
  for (int i = 1; i < count; ++i) {
    files += replay_folder(arguments[i]);
  }
  std::printf("%zu inputs\n", files);
  return files > 0 ? 0 : 1;  // an empty corpus tests nothing
}
