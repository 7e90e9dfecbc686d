// VTube Studio's plugin API 1.0: JSON texts over WebSocket, port 8001.
//
// Sources: github.com/DenchiSoft/VTubeStudio (README, Files/ErrorID.cs), and the input parameters
// in the wiki (VTS Model Settings).
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/frame.h"

namespace mien::protocols {

using VtsControls = std::bitset<formats::kControlCount>;

struct VtsParameter {
  std::string name;
  double value;
};

// VTube Studio's own face parameters. FaceAngle in degrees, FacePosition in cm: the subject's right
// and up are positive. MouthSmile and brows are 0.5 at rest. Unsupported controls count as 0; a
// parameter without a supported control is absent. FacePositionZ is absent, because
// sources differ on its sign.
[[nodiscard]] std::vector<VtsParameter> vts_parameters(const animation::Frame& frame);

// The custom parameter of a control: "MienJawOpen" for jawOpen, because names of two plugins must
// differ. Empty if VTube Studio has an equal parameter of its own.
[[nodiscard]] std::string vts_custom_name(std::size_t control);

[[nodiscard]] std::string vts_state_request();
// Asks the user for permission, unless VTube Studio already does.
[[nodiscard]] std::string vts_token_request();
[[nodiscard]] std::string vts_authentication_request(std::string_view token);
// Creates the custom parameter of a control. The answer has the control as `request`.
[[nodiscard]] std::string vts_creation_request(std::size_t control);
// Sets the parameters of a frame; `custom`: the controls whose parameters have been created. Empty
// if nothing can be set: VTube Studio rejects empty lists.
[[nodiscard]] std::string vts_injection_request(const animation::Frame& frame,
                                                const VtsControls& custom);

enum class VtsAnswerKind : std::uint8_t {
  kState,
  kToken,
  kAuthentication,
  kCreation,
  kInjection,
  kError,
  kOther,
};

inline constexpr std::int64_t kVtsErrorTokenRequestOngoing = 51;
inline constexpr std::size_t kVtsMaxTokenBytes = 64;

struct VtsAnswer {
  VtsAnswerKind kind = VtsAnswerKind::kOther;
  std::string request;         // "state", "token", "authentication", "injection", or a control
  std::string token;           // kToken: 1 to 64 printable characters
  bool authenticated = false;  // kAuthentication
  std::int64_t error = 0;      // kError
  std::string reason;          // kAuthentication, kError
};

// Returns nothing and the reason if the text is not an answer.
[[nodiscard]] std::optional<VtsAnswer> parse_vts_answer(std::string_view text, std::string& fault);

[[nodiscard]] bool is_vts_token(std::string_view text);

}  // namespace mien::protocols
