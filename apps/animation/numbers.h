// Numbers as text, independent of the locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mien::animation {

// The fewest digits that restore the same double.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] std::string fixed(double value, int decimals);

// The double nearest to the fewest decimal digits that restore this float. It is written with these
// digits, and narrowing restores the float.
[[nodiscard]] double decimal(float value);

// Parses the whole text, except surrounding blanks, as a finite number. Returns false and leaves
// `value` unchanged otherwise.
[[nodiscard]] bool parse_number(std::string_view text, double& value);
[[nodiscard]] bool parse_number(std::string_view text, std::int64_t& value);

[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

// For messages: in quotation marks, shortened if long, with '?' for unprintable bytes.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace mien::animation
