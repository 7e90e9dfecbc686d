// Errors of weight files as mien_error_detail: the cause, its position, and the allowed values. Not
// inline, because programs that embed the library want small code.
#pragma once

#include <mien/mien.h>

#include <cstdint>
#include <string_view>

namespace mien::formats {

// No error, or one that `status` describes alone.
[[nodiscard]] mien_error_detail detail_of(mien_status status);

// Describes an error, without a place and values, and returns its status.
mien_status describe(mien_error_detail& detail, mien_status status, const char* field = nullptr);
// `field` has the value `got` instead of one from `min` to `max`.
mien_status describe(mien_error_detail& detail, mien_status status, const char* field, double got,
                     double min, double max);

// Add to a described error.
void set_offset(mien_error_detail& detail, std::uint64_t offset);
void set_got(mien_error_detail& detail, double got);
void set_expected(mien_error_detail& detail, double min, double max);
void set_name(mien_error_detail& detail, std::string_view name);

}  // namespace mien::formats
