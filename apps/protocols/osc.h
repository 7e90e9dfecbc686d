// Open Sound Control 1.0: encoding of messages and bundles (`opensoundcontrol.org`, spec 1_0), with
// booleans of version 1.1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace mien::protocols {

// int32, float32, string, boolean; strings contain no NUL.
using OscArgument = std::variant<std::int32_t, float, std::string_view, bool>;

[[nodiscard]] std::string osc_message(std::string_view address,
                                      std::span<const OscArgument> arguments);

// Packs messages in order into the fewest bundles of at most `max_bytes` each, to be processed
// immediately. A longer message has a bundle of its own.
[[nodiscard]] std::vector<std::string> osc_bundles(std::span<const std::string> messages,
                                                   std::size_t max_bytes);

}  // namespace mien::protocols
