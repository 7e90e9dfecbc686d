// Reads and validates the caller's configuration.
#pragma once

#include <mien/mien.h>

namespace mien::tracker {

// Copies the caller's configuration, which may have any struct_size, over the defaults. Validates
// everything except the content of the weight files.
[[nodiscard]] mien_status read_config(const mien_tracker_config* given,
                                      mien_tracker_config& config);

}  // namespace mien::tracker
