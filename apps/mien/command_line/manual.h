// Generates the manual page from the command line as data.
#pragma once

#include <string>
#include <vector>

#include "apps/mien/command_line/reference.h"

namespace mien::app {

// Returns the page as troff with the macros of man(7).
std::string manual_page(const std::vector<VerbText>& verbs, const std::string& description,
                        const std::string& version);

}  // namespace mien::app
