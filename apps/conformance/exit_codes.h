// Exit codes of mien-conformance: a contract, documented in docs/conformance.md. Values are never
// reused.
#pragma once

namespace mien::conformance {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailures = 1,         // a check failed; with --self-test: a faulty kernel was not detected
  kExitUsage = 2,            // wrong usage
  kExitNothing = 3,          // nothing matches --filter and --tier
  kExitTrimmed = 4,          // this build has no reference kernels
  kExitUnsupportedTier = 5,  // this CPU or build lacks the requested tier
  kExitOutput = 6,           // the JSON file cannot be written
  kExitInternal = 7,         // internal error
  kExitModel = 8             // a weight file is missing, damaged, or of another version
};

}  // namespace mien::conformance
