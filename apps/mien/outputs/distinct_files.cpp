// Compares files by identity.
#include "apps/mien/outputs/distinct_files.h"

#include <filesystem>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardStream = "-";

bool same_file(const std::string& input, const std::string& output) {
  const fs::path in = path_of(input == kStandardStream ? "/dev/stdin" : input);
  const fs::path out = path_of(output == kStandardStream ? "/dev/stdout" : output);
  std::error_code unknown;
  return fs::is_regular_file(in, unknown) && fs::is_regular_file(out, unknown) &&
         fs::equivalent(in, out, unknown);
}

}  // namespace

void require_distinct_files(const std::vector<std::string>& inputs,
                            const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    for (const std::string& input : inputs) {
      if (!input.empty() && !output.empty() && same_file(input, output)) {
        std::string message = output;
        message.append(": the output is the same file as the input ").append(input);
        throw Failure(kExitUsage, message);
      }
    }
  }
}

}  // namespace mien::app
