// The path of this program on Windows.
#include "apps/mien/system/program_path.h"

#include <windows.h>

#include <array>

namespace mien::app {

std::filesystem::path program_path() {
  std::array<wchar_t, 32768> path{};
  const DWORD length = GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
  return std::wstring(path.data(), length);
}

}  // namespace mien::app
