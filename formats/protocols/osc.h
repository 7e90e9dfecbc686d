// Open Sound Control 1.0: what a message and a bundle are in bytes (opensoundcontrol.org, spec
// 1_0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace mien::formats {

// int32, float32, string; strings hold no NUL.
using OscArgument = std::variant<std::int32_t, float, std::string_view>;

[[nodiscard]] std::string osc_message(std::string_view address,
                                      std::span<const OscArgument> arguments);

// Messages in their order in as few bundles, to be taken at once, as hold at most `most_bytes`
// each; a message that is longer by itself goes alone.
[[nodiscard]] std::vector<std::string> osc_bundles(std::span<const std::string> messages,
                                                   std::size_t most_bytes);

}  // namespace mien::formats
