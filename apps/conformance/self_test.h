// The checks themselves are checked.
#pragma once

namespace mien::conformance {

// Runs the planted faults through the same cases as every kernel and prints what was noticed.
// The number that was missed, or noticed as something else.
[[nodiscard]] int self_test();

}  // namespace mien::conformance
