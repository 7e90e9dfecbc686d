// Pages assembled by embed.cmake. Placeholders such as @DATA@ stand for data, @AVATAR@ for the
// avatar's script.
#pragma once

#include <string_view>

namespace mien::app {

extern const char kAvatarScript[];
extern const char kComparePage[];
extern const char kLivePage[];
extern const char kObsPage[];
extern const char kReportPage[];

// The script of the viewer of users' avatars as a zlib stream, empty in Python wheels, and its hash
// for the page's policy.
extern const std::string_view kViewer;
extern const char kViewerHash[];

}  // namespace mien::app
