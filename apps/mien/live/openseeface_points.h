// Landmarks of a result in the order of OpenSeeFace.
#pragma once

#include <mien/mien.h>

#include <mien/mien.hpp>

#include "apps/protocols/openseeface.h"

namespace mien::app {

// The focal length follows from the horizontal field of view.
protocols::OpenSeeFaceImage openseeface_image(const Result& result, const mien_image& image,
                                              float fov_degrees);

// The mirrored landmarks.
protocols::OpenSeeFaceImage mirrored(const protocols::OpenSeeFaceImage& image);

}  // namespace mien::app
