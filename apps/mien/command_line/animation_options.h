// Options of all verbs that write animations.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/mien/outputs/animation_output.h"

namespace mien::app {

// Parses the names of rotation units: rad, norm180, deg.
CLI::Validator rotation_units();

// Parses the names of length units: m, cm, mm, in.
CLI::Validator length_units();

// Adds --llf-rot, --llf-fps, --bvh-unit and --roblox-lod.
void add_writing_options(CLI::App& verb, animation::WriteOptions& options);

// Adds --avatar.
void add_avatar(CLI::App& verb, std::string& avatar);

}  // namespace mien::app
