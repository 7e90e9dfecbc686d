// Tests the checks themselves.
#pragma once

namespace mien::conformance {

// Checks faulty kernels with the cases of their family and prints the results. Returns the number
// of kernels whose fault was not detected, or detected as another one.
[[nodiscard]] int self_test();

}  // namespace mien::conformance
