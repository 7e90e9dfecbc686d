// Reports errors in the caller's mien_error_detail.
#include "tracker/api/report.h"

#include <cstdint>

#include "tracker/api/versioned_struct.h"

namespace mien::tracker {

mien_status check_memory(const void* memory, mien_error_detail& error) {
  if (memory == nullptr) {
    return fail(error, MIEN_ERROR_NULL_ARGUMENT, "memory");
  }
  return reinterpret_cast<std::uintptr_t>(memory) % MIEN_ALIGNMENT == 0
             ? MIEN_OK
             : fail(error, MIEN_ERROR_ALIGNMENT, "memory");
}

mien_status check_size(std::size_t given, std::size_t required, mien_error_detail& error) {
  const auto expected = static_cast<double>(required);
  return given >= required ? MIEN_OK
                           : formats::describe(error, MIEN_ERROR_MEMORY_TOO_SMALL, "memory_bytes",
                                               static_cast<double>(given), expected, expected);
}

mien_status report(mien_status status, const mien_error_detail& error, mien_error_detail* given) {
  if (given != nullptr) {
    // Some errors have no detail.
    const mien_error_detail whole = error.status == status ? error : formats::detail_of(status);
    (void)write_struct(whole, MIEN_SIZE_THROUGH(mien_error_detail, status), given);
  }
  return status;
}

}  // namespace mien::tracker
