// Reads and writes files with a secret.
#include "apps/mien/outputs/private_file.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLineBytes = 256;

}  // namespace

std::optional<std::string> private_line(const std::string& path) {
  std::error_code unknown;
  if (!fs::exists(path_of(path), unknown)) {
    return std::nullopt;
  }
  std::ifstream file(path_of(path));
  std::string line(kMaxLineBytes, '\0');
  file.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(file.gcount()));
  return line.substr(0, line.find_first_of("\r\n"));
}

// Restricts the file before it has content.
void write_private_line(const std::string& path, const std::string& line, const std::string& what) {
  std::error_code failed;
  PartialFile file(path, TemporaryFile::Ending::kAny);
  fs::permissions(path_of(file.name()), fs::perms::owner_read | fs::perms::owner_write, failed);
  std::FILE* stream = failed ? nullptr : file.open();
  const bool written = stream != nullptr && std::fputs((line + '\n').c_str(), stream) >= 0;
  if (stream == nullptr || std::fclose(stream) != 0 || !written) {
    throw Failure(kExitOutput, what + " " + path + ": cannot be written");
  }
  file.publish();
}

}  // namespace mien::app
