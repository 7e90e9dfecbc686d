// Exit codes of mien-conformance: a contract, documented in docs/conformance.md. Numbers are never
// reused.
#pragma once

namespace mien::conformance {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailures = 1,  // a kernel or a network is wrong; of --self-test: a planted fault was missed
  kExitUsage = 2,     // unknown option, bad value
  kExitNothing = 3,   // nothing matches --filter and --tier
  kExitTrimmed = 4,   // this build has no reference kernels
  kExitUnsupportedTier = 5,  // this CPU or this build lacks the tier asked for
  kExitOutput = 6,           // the JSON file cannot be written
  kExitInternal = 7,         // a fault of the program itself
  kExitModel = 8             // a weight file is missing, damaged, or of another version
};

}  // namespace mien::conformance
