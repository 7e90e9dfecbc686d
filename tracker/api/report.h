// Reports errors of the C API in the caller's mien_error_detail.
#pragma once

#include <mien/mien.h>

#include <cstddef>

#include "formats/error_detail.h"

namespace mien::tracker {

// Describes an error and returns its status.
inline mien_status fail(mien_error_detail& error, mien_status status, const char* field = nullptr) {
  formats::describe(error, status, field);
  return status;  // which static analysis cannot see through a call
}

// Checks the memory of a create_in function.
[[nodiscard]] mien_status check_memory(const void* memory, mien_error_detail& error);
[[nodiscard]] mien_status check_size(std::size_t given, std::size_t required,
                                     mien_error_detail& error);

// Copies the detail of a call that returns `status` to the caller, if the caller wants one.
mien_status report(mien_status status, const mien_error_detail& error, mien_error_detail* given);

}  // namespace mien::tracker
