// Converts a result of the tracker to a frame of an animation.
#pragma once

#include <cstdint>
#include <mien/mien.hpp>

#include "apps/animation/clip.h"

namespace mien::app {

animation::Frame frame_of(std::int64_t number, const Result& result);

}  // namespace mien::app
