// Fills error details.
#include "formats/error_detail.h"

#include <algorithm>
#include <cstddef>

namespace mien::formats {

mien_error_detail detail_of(mien_status status) {
  mien_error_detail detail;
  describe(detail, status);
  return detail;
}

mien_status describe(mien_error_detail& detail, mien_status status, const char* field) {
  detail = {};
  detail.struct_size = sizeof detail;
  detail.status = status;
  detail.file = detail.network = detail.layer = -1;
  detail.field = field;
  return status;
}

mien_status describe(mien_error_detail& detail, mien_status status, const char* field, double got,
                     double min, double max) {
  describe(detail, status, field);
  set_got(detail, got);
  set_expected(detail, min, max);
  return status;
}

void set_offset(mien_error_detail& detail, std::uint64_t offset) {
  detail.known |= MIEN_DETAIL_OFFSET;
  detail.offset = offset;
}

void set_got(mien_error_detail& detail, double got) {
  detail.known |= MIEN_DETAIL_GOT;
  detail.got = got;
}

void set_expected(mien_error_detail& detail, double min, double max) {
  detail.known |= MIEN_DETAIL_EXPECTED;
  detail.expected_min = min;
  detail.expected_max = max;
}

void set_name(mien_error_detail& detail, std::string_view name) {
  const std::size_t bytes = std::min<std::size_t>(name.size(), MIEN_MAX_NAME_BYTES);
  std::copy_n(name.begin(), bytes, detail.name);
  detail.name[bytes] = '\0';
}

}  // namespace mien::formats
