// Generates completions for bash, zsh and fish.
#pragma once

#include <string>
#include <vector>

#include "apps/mien/command_line/reference.h"

namespace mien::app {

std::string bash_completion(const std::vector<VerbText>& verbs);
std::string zsh_completion(const std::vector<VerbText>& verbs);
std::string fish_completion(const std::vector<VerbText>& verbs);

}  // namespace mien::app
