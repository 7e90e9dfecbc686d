// Landmarks of a result in the order in which other programs know them.
#pragma once

#include <mien/mien.h>

#include <mien/mien.hpp>

#include "formats/protocols/openseeface.h"

namespace mien::app {

// The focal length is that of the horizontal field of view.
formats::OpenSeeFacePicture openseeface_picture(const Result& result, const mien_image& image,
                                                float fov_degrees);

// As a mirror shows it.
formats::OpenSeeFacePicture mirrored(const formats::OpenSeeFacePicture& picture);

}  // namespace mien::app
