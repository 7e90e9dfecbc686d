// Pages before their data, put together by embed.cmake: the marks of what is still to come are in
// them, as @DATA@.
#pragma once

namespace mien::app {

extern const char kComparePage[];
extern const char kReportPage[];

}  // namespace mien::app
