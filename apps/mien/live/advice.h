// Says what to do about a camera or a microphone that does not open.
#pragma once

#include <string>

#include "apps/mien/sources/capture.h"

namespace mien::app {

// Appends advice to the error of an input device. Returns other errors unchanged.
[[nodiscard]] std::string advised(CaptureKind kind, const std::string& error);

}  // namespace mien::app
