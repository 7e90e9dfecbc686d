// Reads facial animations from files of any supported format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "apps/animation/animation.h"

namespace mien::app {

// Returns the content of a file, or of standard input for "-". Throws Failure(kExitNoInput).
std::string read_whole(const std::string& path);

// The path of the JSON file with the units of a Live Link Face file.
std::string live_link_notes_of(const std::string& path);

// Options from FILE.json beside a Live Link Face file, and a loader for other files in its folder.
// Default options for "-". Throws Failure(kExitNoInput).
animation::ReadOptions read_options_for(const std::string& path);

// Parses `bytes`. Messages refer to the input as `name`. Without `format`, the content decides.
// Throws Failure(kExitNoInput) with line and column.
animation::Clip parse_animation(std::string_view bytes, const std::string& name,
                                std::optional<animation::AnimationFormat> format,
                                const animation::ReadOptions& options);

// Prints the notes of a clip, such as assumed units, to standard error.
void print_notes(const std::string& name, const animation::Clip& clip);

}  // namespace mien::app
