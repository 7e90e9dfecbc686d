// Files and aligned bytes for tests of the weight format.
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

// Bytes that begin at a multiple of 64, in an allocation that ends where they end, so that the
// address sanitizer sees every read behind them.
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

// Reads the file; on success walks over everything that the view hands out.
Validation open_copy(std::span<const std::byte> file);

// The name that a list gives a status; empty where it gives none.
template <class Status, std::size_t n>
std::string name_in(const std::pair<Status, const char*> (&names)[n], Status status) {
  const auto* found = std::ranges::find(names, status, &std::pair<Status, const char*>::first);
  return found != std::end(names) ? found->second : "";
}

// Enumerator's name, such as "kBadOp".
std::string status_name(FileStatus status);

// The lines that second_reader.py prints for the file.
std::string described(const FileView& view);

// Standard output of a shell command, which must succeed.
std::string output_of(const std::string& command);

}  // namespace mien::formats
