// Animations of faces, from files of any format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/animation/animation.h"

namespace mien::app {

// The whole file, or standard input for "-". Throws Failure(kExitNoInput).
std::string read_whole(const std::string& path);

// The file beside one of Live Link Face that says what the file itself cannot.
std::string live_link_notes_of(const std::string& path);

// What FILE.json beside a file of Live Link Face says that the file itself cannot, and where the
// file finds others beside it; for "-" nothing. Throws Failure(kExitNoInput).
formats::ReadOptions read_options_for(const std::string& path);

// `name` is what messages call it; without a format its content says which. Throws
// Failure(kExitNoInput) that names line and column.
formats::Clip parse_animation(std::string_view bytes, const std::string& name,
                              std::optional<formats::AnimationFormat> format,
                              const formats::ReadOptions& options);

// What was taken for granted, a line each on standard error.
void print_notes(const std::string& name, const formats::Clip& clip);

}  // namespace mien::app
