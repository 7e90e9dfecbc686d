// Creates and keeps tokens.
#include "apps/mien/live_page/token.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string_view>
#include <system_error>

#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kTokenDigits = 32;

bool is_token(std::string_view text) {
  return text.size() == kTokenDigits && text.find_first_not_of(kDigits) == std::string_view::npos;
}

// Restricts the file before it has content.
void create(const std::string& path, const std::string& token) {
  PartialFile file(path, TemporaryFile::Ending::kAny);
  std::error_code failed;
  fs::permissions(path_of(file.name()), fs::perms::owner_read | fs::perms::owner_write, failed);
  std::FILE* stream = failed ? nullptr : file.open();
  const bool written = stream != nullptr && std::fputs((token + '\n').c_str(), stream) >= 0;
  if (stream == nullptr || std::fclose(stream) != 0 || !written) {
    throw Failure(kExitOutput, "--page-token " + path + ": cannot be written");
  }
  file.publish();
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
  std::error_code unknown;
  if (!fs::exists(path_of(path), unknown)) {
    const std::string token = new_token();
    create(path, token);
    return token;
  }
  std::ifstream file(path_of(path));
  std::string token(kTokenDigits, '\0');
  file.read(token.data(), static_cast<std::streamsize>(token.size()));
  const int end = file.get();
  if (!is_token(token) ||
      (end != std::ifstream::traits_type::eof() && end != '\n' && end != '\r')) {
    throw Failure(kExitNoInput, "--page-token " + path +
                                    ": not a token (expected 32 hexadecimal digits in lower case)");
  }
  return token;
}

}  // namespace mien::app
