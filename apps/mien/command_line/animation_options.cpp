// Options of all verbs that write animations.
#include "apps/mien/command_line/animation_options.h"

#include <string>

#include "apps/mien/command_line/option_values.h"

namespace mien::app {

CLI::Validator rotation_units() {
  using animation::RotationUnit;
  return one_of<RotationUnit>({{"rad", RotationUnit::kRadians},
                               {"norm180", RotationUnit::kDegreesBy180},
                               {"deg", RotationUnit::kDegrees}});
}

CLI::Validator length_units() {
  using animation::LengthUnit;
  return one_of<LengthUnit>({{"m", LengthUnit::kMetres},
                             {"cm", LengthUnit::kCentimetres},
                             {"mm", LengthUnit::kMillimetres},
                             {"in", LengthUnit::kInches}});
}

void add_writing_options(CLI::App& verb, animation::WriteOptions& options) {
  verb.add_option("--llf-rot", options.live_link.rotation,
                  "unit of Live Link Face rotations: rad (default), norm180 (degrees / 180) or deg")
      ->transform(rotation_units());
  verb.add_option("--llf-fps", options.live_link.timecode_fps,
                  "frames per second of the Live Link Face timecode, 1 to 100 (default 60)")
      ->check(number_from(1.0, 100.0));
  verb.add_option("--bvh-unit", options.bvh_unit,
                  "unit of BVH positions: m (default), cm, mm or in")
      ->transform(length_units());
  verb.add_option("--roblox-lod", options.roblox_level_1,
                  "Roblox action units: 0 (all 50, default) or 1 (the 6 of its level of detail 1)")
      ->transform(one_of<bool>({{"0", false}, {"1", true}}));
}

void add_avatar(CLI::App& verb, std::string& avatar) {
  verb.add_option("--avatar", avatar,
                  "avatar (.glb, .vrm) that .glb outputs and reports contain, moved by its morph "
                  "targets, head and eyes");
}

}  // namespace mien::app
