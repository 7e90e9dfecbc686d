// Options of all verbs that write animations.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

// Takes the names of units of Live Link Face's rotations.
CLI::Validator rotation_units();

// Takes the names of units of positions.
CLI::Validator length_units();

// --llf-rot, --llf-fps, --roblox-lod, --bvh-unit.
void add_writing_options(CLI::App& verb, formats::WriteOptions& options);

}  // namespace mien::app
