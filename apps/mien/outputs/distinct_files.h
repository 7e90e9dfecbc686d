// Protects inputs from being overwritten.
#pragma once

#include <string>
#include <vector>

namespace mien::app {

// Throws Failure(kExitUsage) if an output is the same file as an input, also through a link or
// under another name. "-" is standard input or output; empty names and URLs are skipped. Every verb
// must call this before it writes a file.
void require_distinct_files(const std::vector<std::string>& inputs,
                            const std::vector<std::string>& outputs);

}  // namespace mien::app
