// Reads and validates the caller's configuration.
#pragma once

#include <mien/mien.h>

namespace mien::tracker {

// Copies the caller's configuration, which may have any struct_size, over the defaults, and
// validates it. `max_lod` becomes 1 without HiFiNet. On error, `error` describes it.
[[nodiscard]] mien_status read_config(const mien_tracker_config* given, mien_tracker_config& config,
                                      mien_error_detail& error);

}  // namespace mien::tracker
