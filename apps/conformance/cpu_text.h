// Texts about processors, from what Linux says of them.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace mien::conformance {

// One name for each processor of /proc/cpuinfo: the model, or on ARM implementer and part (Main ID
// Register, Arm Architecture Reference Manual).
[[nodiscard]] std::vector<std::string> processor_names(std::istream& cpuinfo);

// "1800000", in kHz, becomes ", 1.8 GHz"; other text nothing.
[[nodiscard]] std::string frequency_text(const std::string& kilohertz);

// Equal neighbours are counted: {"a", "a", "b"} becomes "2 x a; 1 x b".
[[nodiscard]] std::string counted(const std::vector<std::string>& names);

}  // namespace mien::conformance
