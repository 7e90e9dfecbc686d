// The path of this program on POSIX systems.
#include "apps/mien/system/program_path.h"

#ifdef __APPLE__
#include <limits.h>
#include <mach-o/dyld.h>

#include <array>
#include <cstdint>
#endif

namespace mien::app {

#ifdef __APPLE__
std::filesystem::path program_path() {
  std::array<char, PATH_MAX> path{};
  auto bytes = static_cast<std::uint32_t>(path.size());
  std::error_code unknown;
  return _NSGetExecutablePath(path.data(), &bytes) == 0
             ? std::filesystem::canonical(path.data(), unknown)
             : std::filesystem::path();
}
#else
std::filesystem::path program_path() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}
#endif

}  // namespace mien::app
