// The file of --profile.
#pragma once

#include <mien/mien.hpp>
#include <string>

#include "apps/mien/live/profile.h"

namespace mien::app {

// Reads a profile and restores its neutral values. A file that does not exist is an empty profile
// if `may_be_absent`. Throws Failure.
[[nodiscard]] Profile load_profile(const std::string& path, bool may_be_absent, Tracker& tracker);

// Updates the neutral values of the profile from the tracker. Throws Failure.
void take_neutral(const Tracker& tracker, Profile& profile);

// Throws Failure(kExitOutput).
void save_profile(const std::string& path, const Profile& profile);

}  // namespace mien::app
