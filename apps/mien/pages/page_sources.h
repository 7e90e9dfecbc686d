// Pages assembled by embed.cmake. Placeholders such as @DATA@ stand for data.
#pragma once

namespace mien::app {

extern const char kComparePage[];
extern const char kLivePage[];
extern const char kObsPage[];
extern const char kReportPage[];

}  // namespace mien::app
