// Checks that a kernel preserves callee-saved registers.
#pragma once

#include <cstdint>
#include <string>

namespace mien::conformance {

// The calling convention: "x86-64 System V: rbx, rbp, ..."; nullptr if there is no check for it.
[[nodiscard]] const char* register_convention();

// Calls kernel(args) with known values in all callee-saved registers. The result has a bit for each
// register that the kernel changed; the caller's values are restored in any case. Requires that
// register_convention() is not nullptr.
[[nodiscard]] std::uint32_t call_checked(void (*kernel)(), const void* args);

// "rbx, mxcsr"
[[nodiscard]] std::string register_names(std::uint32_t changed);

}  // namespace mien::conformance
