// Reads and writes the file of --profile.
#include "apps/mien/live/profile_file.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "apps/mien/networks/model_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {

Profile load_profile(const std::string& path, bool may_be_absent, Tracker& tracker) {
  std::error_code unknown;
  if (may_be_absent && !std::filesystem::exists(path_of(path), unknown)) {
    return {};
  }
  const Blob file(path, kExitNoInput);
  std::string fault;
  const std::optional<Profile> profile =
      parse_profile({static_cast<const char*>(file.data()), file.size()}, fault);
  if (!profile) {
    throw Failure(kExitNoInput, path + ": " + fault);
  }
  if (!profile->neutral.empty()) {
    const mien_status status = tracker.load_neutral(std::as_bytes(std::span(profile->neutral)));
    if (status != MIEN_OK) {
      throw Failure(kExitNoInput, path + ": neutral: " + message(status));
    }
  }
  return *profile;
}

void take_neutral(const Tracker& tracker, Profile& profile) {
  std::array<std::byte, MIEN_NEUTRAL_BYTES> bytes = {};
  std::uint32_t captured = 0;
  check(tracker.save_neutral(bytes, captured), "calibration");
  profile.neutral = captured != 0
                        ? std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())
                        : std::string();
}

void save_profile(const std::string& path, const Profile& profile) {
  OutputFile file(path);
  file.write(profile_text(profile));
  file.finish();
}

}  // namespace mien::app
