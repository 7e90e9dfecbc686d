// Landmarks of a result in the order in which other programs know them.
#pragma once

#include <mien/mien.h>

#include <mien/mien.hpp>

#include "formats/protocols/openseeface.h"

namespace mien::app {

// The focal length is the one that the tracker assumes of a camera that it does not know.
formats::OpenSeeFacePicture openseeface_picture(const Result& result, const mien_image& image);

// As a mirror shows it.
formats::OpenSeeFacePicture mirrored(const formats::OpenSeeFacePicture& picture);

}  // namespace mien::app
