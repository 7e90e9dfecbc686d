// Pages assembled by embed.cmake. Placeholders such as @DATA@ stand for data, @AVATAR@ for the
// avatar's script.
#pragma once

namespace mien::app {

extern const char kAvatarScript[];
extern const char kComparePage[];
extern const char kLivePage[];
extern const char kObsPage[];
extern const char kReportPage[];

}  // namespace mien::app
