// The secret part of the page's address.
#pragma once

#include <string>

namespace mien::app {

// 32 random hexadecimal digits: 128 bits.
[[nodiscard]] std::string new_token();

// The token in a file, so that the address stays the same. Creates the file, which only its owner
// can read, if it does not exist. Throws Failure.
[[nodiscard]] std::string kept_token(const std::string& path);

}  // namespace mien::app
