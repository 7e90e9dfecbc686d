// The caller's configuration: defaults and validation.
#pragma once

#include <mien/mien.h>

namespace mien::tracker {

// Copies the caller's configuration, of whatever struct_size, over the defaults and checks all of
// it but the content of the weight files.
[[nodiscard]] mien_status read_config(const mien_tracker_config* given,
                                      mien_tracker_config& config);

}  // namespace mien::tracker
