// Creates and keeps tokens.
#include "apps/mien/live_page/token.h"

#include <algorithm>
#include <optional>
#include <random>
#include <string_view>

#include "apps/mien/outputs/private_file.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kTokenDigits = 32;

bool is_token(std::string_view text) {
  return text.size() == kTokenDigits && text.find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

std::string new_token() {
  std::random_device device;  // the operating system's random numbers
  std::uniform_int_distribution<std::size_t> digit(0, kDigits.size() - 1);
  std::string token(kTokenDigits, '\0');
  std::generate(token.begin(), token.end(), [&] { return kDigits[digit(device)]; });
  return token;
}

std::string kept_token(const std::string& path) {
  const std::optional<std::string> kept = private_line(path);
  if (!kept) {
    const std::string token = new_token();
    write_private_line(path, token, "--page-token");
    return token;
  }
  if (!is_token(*kept)) {
    throw Failure(kExitNoInput, "--page-token " + path +
                                    ": not a token (expected 32 hexadecimal digits in lower case)");
  }
  return *kept;
}

}  // namespace mien::app
