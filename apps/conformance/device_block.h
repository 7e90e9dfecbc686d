// A block of text about a device, for docs/results/devices.md.
#pragma once

#include <string>

#include "apps/conformance/report.h"

namespace mien::conformance {

// Markdown: the device and its processors as far as the system tells, the time of the networks of
// a frame at levels 1 and 4, and the result of the checks. `report` has timings.
[[nodiscard]] std::string device_block(const Report& report);

}  // namespace mien::conformance
