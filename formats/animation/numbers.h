// Numbers as text, whatever the locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mien::formats {

// The fewest digits that read back the same.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] std::string fixed(double value, int decimals);

// The double nearest to the fewest decimal digits that read back as this float, so that a float is
// written with these digits wherever it goes, and is itself again when it is narrowed.
[[nodiscard]] double decimal(float value);

// The whole text, blanks around it aside, as one finite number. False, and `value` as it was,
// where it is none.
[[nodiscard]] bool parse_number(std::string_view text, double& value);
[[nodiscard]] bool parse_number(std::string_view text, std::int64_t& value);

[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

// For a message: in quotation marks, shortened where it is long, unprintable bytes as '?'.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace mien::formats
