// Pages assembled by embed.cmake. They contain marks such as @DATA@ for data.
#pragma once

namespace mien::app {

extern const char kComparePage[];
extern const char kReportPage[];

}  // namespace mien::app
