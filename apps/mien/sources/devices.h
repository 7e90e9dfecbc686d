// Implements `mien devices`, which lists cameras and microphones.
#pragma once

#include <vector>

#include "apps/mien/sources/device_lists.h"

namespace mien::app {

// Throws Failure(kExitNoFfmpeg).
std::vector<Device> devices();
void print_devices(bool json);

}  // namespace mien::app
