// Creates weight files from JSON descriptions with the C++ writer, as
// tests/golden/format/describe.py does with the Python writer.
#pragma once

#include <string>
#include <vector>

#include "formats/mien_file.h"

namespace mien::formats {

mien_error_detail write_described(const std::string& description_path,
                                  std::vector<std::byte>* file);

}  // namespace mien::formats
