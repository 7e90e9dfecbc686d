// CSV as Epic's Live Link Face records it: 63 columns, of which JawRight, JawLeft and MouthRight,
// MouthLeft stand in another order than in its packets.
//
// Timecode is HH:MM:SS:FF.mmm, counted in frames of a second. The nine rotations are radians as the
// app writes them, or degrees / 180 as Unreal's own AppleARKit publisher has them, or degrees; the
// file does not say which. Epic does not document their signs; as in a capture with eyes cast down,
// and as MeFaMo sends them, pitch is positive upwards; yaw and roll have our signs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "formats/animation/clip.h"
#include "formats/animation/writer.h"

namespace mien::formats {

enum class RotationUnit : std::uint8_t { kRadians, kDegreesBy180, kDegrees };
[[nodiscard]] double units_per_radian(RotationUnit unit);
[[nodiscard]] const char* name(RotationUnit unit);  // "radians", ... Static.

// Yaw, pitch, roll of head, left eye, right eye, in the order of kRotationNames: what files and
// packets have behind the controls. Eyes without rotations of their own look as the controls say.
[[nodiscard]] std::array<double, kRotationCount> live_link_rotations(const Frame& frame,
                                                                     RotationUnit unit);

// Neither a face nor a voice that moves the mouth.
[[nodiscard]] bool shows_nothing(const Frame& frame);

// Of what is written.
struct LiveLinkOptions {
  RotationUnit rotation = RotationUnit::kRadians;
  double timecode_fps = 60.0;  // 1..100
};

// A frame without a face and without a voice that moves the mouth has BlendshapeCount 0 and empty
// cells behind it.
[[nodiscard]] std::unique_ptr<AnimationWriter> live_link_csv_writer(const LiveLinkOptions& options);

}  // namespace mien::formats
