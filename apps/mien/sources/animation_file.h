// Animations of faces, from files of any format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/animation/animation.h"

namespace mien::app {

// The whole file, or standard input for "-". Throws Failure(kExitNoInput).
std::string read_whole(const std::string& path);

// What FILE.json beside a file of Live Link Face says that the file itself cannot; without it, or
// for "-", what is usual. Throws Failure(kExitNoInput).
formats::LiveLinkOptions read_live_link_notes(const std::string& path);

// `name` is what messages call it; without a format its content says which. Throws
// Failure(kExitNoInput) that names line and column.
formats::Clip parse_animation(std::string_view bytes, const std::string& name,
                              std::optional<formats::AnimationFormat> format,
                              const formats::LiveLinkOptions& live_link);

}  // namespace mien::app
