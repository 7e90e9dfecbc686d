// The folder for settings on Windows.
#include "apps/mien/system/config_folder.h"

#include <cstdlib>

namespace mien::app {

std::filesystem::path config_folder() {
  const wchar_t* folder = _wgetenv(L"APPDATA");
  return folder == nullptr ? std::filesystem::path() : std::filesystem::path(folder) / L"mien";
}

}  // namespace mien::app
