// What shells complete the words of this program by.
#pragma once

#include <string>
#include <vector>

#include "apps/mien/command_line/reference.h"

namespace mien::app {

std::string bash_completion(const std::vector<VerbText>& verbs);
std::string zsh_completion(const std::vector<VerbText>& verbs);
std::string fish_completion(const std::vector<VerbText>& verbs);

}  // namespace mien::app
