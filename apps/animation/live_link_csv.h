// CSV as Epic's Live Link Face records it: 63 columns. JawRight, JawLeft and MouthRight, MouthLeft
// have another order than in its packets.
//
// The timecode is HH:MM:SS:FF.mmm, in frames of a second. The nine rotations are in radians as the
// app writes them, in degrees / 180 as Unreal's AppleARKit publisher writes them, or in degrees;
// the file does not specify the unit. Epic does not document their signs. As in a capture with
// lowered eyes, and in MeFaMo's output, pitch is positive upwards; yaw and roll have our signs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "apps/animation/clip.h"
#include "apps/animation/writer.h"

namespace mien::animation {

enum class RotationUnit : std::uint8_t { kRadians, kDegreesBy180, kDegrees };
[[nodiscard]] double units_per_radian(RotationUnit unit);
[[nodiscard]] const char* name(RotationUnit unit);  // "radians", ... Static.

// Yaw, pitch, roll of head, left eye, right eye, in the order of kRotationNames, as they follow the
// controls in files and packets. Eyes without rotations follow the controls.
[[nodiscard]] std::array<double, formats::kRotationCount> live_link_rotations(const Frame& frame,
                                                                              RotationUnit unit);

// Whether a frame has neither a face nor voice activity that moves the mouth.
[[nodiscard]] bool is_blank(const Frame& frame);

// Options of the writer.
struct LiveLinkOptions {
  RotationUnit rotation = RotationUnit::kRadians;
  double timecode_fps = 60.0;  // 1..100
};

// A frame without a face and voice has BlendshapeCount 0 and empty cells after it.
[[nodiscard]] std::unique_ptr<AnimationWriter> live_link_csv_writer(const LiveLinkOptions& options);

}  // namespace mien::animation
