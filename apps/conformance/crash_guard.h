// Runs code that may die, and lives on.
#pragma once

namespace mien::conformance {

// False where the system tells nobody about faults (WebAssembly): there a crash ends the run.
[[nodiscard]] bool can_catch_crashes();

// Calls body(context). nullptr if it came back, else what it died of: "SIGSEGV: ...". The floating
// point environment is as before then; destructors of what `body` was doing have not run.
[[nodiscard]] const char* run_guarded(void (*body)(void*), void* context);

}  // namespace mien::conformance
