// Files and aligned memory for tests of the weight format.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/mien_file.h"

namespace mien::formats {

inline constexpr const char* kPython = "/usr/bin/python3";
inline constexpr const char* kPythonCommand =
    "PYTHONPATH=" MIEN_SOURCE_DIR "/apps/convert /usr/bin/python3 ";

// Memory aligned to 64 bytes, whose allocation ends with the data, so that the address sanitizer
// detects every read beyond it.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::span<const std::byte> bytes);
  ~AlignedBytes();
  AlignedBytes(const AlignedBytes&) = delete;
  AlignedBytes& operator=(const AlignedBytes&) = delete;
  std::span<std::byte> get() { return {bytes_, size_}; }

 private:
  std::byte* bytes_;
  std::size_t size_;
};

std::string golden_folder();                   // tests/golden/format/
std::string name_of(const std::string& path);  // without its folder
std::vector<std::byte> read_file(const std::string& path);
std::vector<std::string> files_in(const std::string& folder, const std::string& ending);

void fix_checksum(std::span<std::byte> file);

// Reads a file; on success visits everything that the view provides.
mien_error_detail open_copy(std::span<const std::byte> file);

// The name of a status in a list; empty if it is absent.
template <class Status, std::size_t n>
std::string name_in(const std::pair<Status, const char*> (&names)[n], Status status) {
  const auto* found = std::ranges::find(names, status, &std::pair<Status, const char*>::first);
  return found != std::end(names) ? found->second : "";
}

// Name of the enumerator, such as "kBadOp".
std::string status_name(std::int32_t status);

// The lines that second_reader.py prints for the file.
std::string described(const FileView& view);

// Standard output of a shell command, which must succeed.
std::string output_of(const std::string& command);

}  // namespace mien::formats
