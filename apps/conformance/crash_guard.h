// Runs code that may crash and continues afterwards.
#pragma once

namespace mien::conformance {

// False if the system does not report crashes (WebAssembly); a crash then ends the program.
[[nodiscard]] bool can_catch_crashes();

// Calls body(context). Returns nullptr, or the cause of the crash: "SIGSEGV: ...". After a crash
// the floating-point environment is restored, but destructors of `body` have not run.
[[nodiscard]] const char* run_guarded(void (*body)(void*), void* context);

}  // namespace mien::conformance
