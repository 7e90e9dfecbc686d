// Face parameters of VRChat's avatars, as OSC over UDP, port 9000: the Unified Expressions of
// VRCFaceTracking 5, and VRChat's own eye tracking.
//
// Sources: docs.vrcft.io (Parameters; Unified Expressions, ARKit), docs.vrchat.com (OSC Avatar
// Parameters; OSC Eye Tracking).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/frame.h"

namespace mien::protocols {

struct VrchatParameter {
  std::string name;  // "JawOpen"
  double value;      // 0..1; -1..1 for directions and opposites
};

// The parameters v2/NAME. Unsupported controls count as 0; a parameter without a
// supported control is absent. EyeLeftX and the like are 1 at 45 degrees; right and up are
// positive.
[[nodiscard]] std::vector<VrchatParameter> vrchat_parameters(const animation::Frame& frame);

struct VrchatOptions {
  std::string prefix;       // before "v2/": empty, or "FT/"
  bool native_eyes = true;  // /tracking/eye/
};

// Bundles of at most 1500 bytes. While a face is tracked, /tracking/eye/ has the direction of both
// eyes and their mean closure; afterwards VRChat's automatic eyes return within 10 s.
[[nodiscard]] std::vector<std::string> vrchat_packets(const animation::Frame& frame,
                                                      const VrchatOptions& options);

}  // namespace mien::protocols
