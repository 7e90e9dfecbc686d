// Whether a kernel leaves the registers alone that its caller owns.
#pragma once

#include <cstdint>
#include <string>

namespace mien::conformance {

// The convention checked: "x86-64 System V: rbx, rbp, ..."; nullptr where there is no check.
[[nodiscard]] const char* register_convention();

// Calls kernel(args) with known values in all registers that it has to preserve. The result has a
// bit for each that came back changed, 0 if none did; they are the caller's again in any case.
// Only where register_convention() is not nullptr.
[[nodiscard]] std::uint32_t call_checked(void (*kernel)(), const void* args);

// "rbx, mxcsr"
[[nodiscard]] std::string register_names(std::uint32_t changed);

}  // namespace mien::conformance
