// Files and aligned bytes for tests of the weight format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/mien_file.h"

namespace mien::formats {

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

std::string golden_folder();  // tests/golden/format/
std::vector<std::byte> read_file(const std::string& path);
std::vector<std::string> files_in(const std::string& folder, const std::string& ending);

void fix_checksum(std::span<std::byte> file);

// Reads the file; on success walks over everything that the view hands out.
Validation open_copy(std::span<const std::byte> file);

// Enumerator's name, such as "kBadOp".
std::string status_name(FileStatus status);

// The lines that second_reader.py prints for the file.
std::string described(const FileView& view);

// Standard output of a shell command, which must succeed.
std::string output_of(const std::string& command);

}  // namespace mien::formats
