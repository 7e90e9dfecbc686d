// A frame of facial animation, which all formats of this folder read and write.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {

enum class FaceState : std::uint8_t { kSearching, kTracking, kLost };

// "searching", "tracking", "lost". Static.
[[nodiscard]] const char* name(FaceState state);

// Radians; R = Ry(yaw) Rx(pitch) Rz(roll), right-handed, y up, z out of the face. Positive pitch
// looks down; positive yaw turns to the subject's left.
struct Angles {
  double pitch = 0.0, yaw = 0.0, roll = 0.0;
};

struct Frame {
  std::int64_t number = 0;
  std::int64_t time_ns = 0;  // satisfies time_allowed
  FaceState state = FaceState::kTracking;
  std::int64_t face_id = 0;
  double face_probability = formats::kNoNumber;  // 0..1
  double voice_activity = formats::kNoNumber;    // 0..1
  std::int64_t lod = 0;                          // 0: unknown

  std::optional<std::array<double, 4>> box;         // x, y, width, height, pixels
  std::optional<Angles> head;                       // head to camera
  std::optional<std::array<double, 3>> position_m;  // of the head, camera space
  std::optional<std::array<Angles, 2>> eyes;        // left, right; eye to head

  // 0..1 in the order of kArkitNames; kNoNumber for unsupported controls.
  std::array<double, formats::kControlCount> controls;

  // Values of a file in another vocabulary; `controls` are derived from them.
  std::vector<double> facs;     // empty, or 50 in 0..1 in the order of kFacsNames, or kNoNumber
  std::vector<double> visemes;  // empty, or 15 in 0..1 in the order of kVisemeNames, or kNoNumber
  char mouth_shape = 0;         // 0, or one of kMouthShapes, held until the next frame
  bool step = false;            // values are held until the next frame

  // Whether the values are held until the next frame instead of interpolated.
  [[nodiscard]] bool holds() const { return step || mouth_shape != 0; }

  Frame() { controls.fill(formats::kNoNumber); }

  // Rounded once: no 33.333332999999996.
  [[nodiscard]] double time_ms() const;
};

// The limit of times is 146 years before and after 0, so differences fit into 64 bits as well. It
// includes nanoseconds since 1970.
inline constexpr std::int64_t kLastTime_ns = (std::int64_t{1} << 62) - 1;
[[nodiscard]] constexpr bool time_allowed(std::int64_t time_ns) {
  return -kLastTime_ns <= time_ns && time_ns <= kLastTime_ns;
}

// Converts units of time to nanoseconds. Returns false and leaves `time_ns` unchanged if the result
// is not allowed.
[[nodiscard]] bool time_of(double units, std::int64_t unit_ns, std::int64_t& time_ns);
inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::int64_t kMillisecond_ns = 1'000'000;

}  // namespace mien::animation
