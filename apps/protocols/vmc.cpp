// Writes VMC packets.
#include "apps/protocols/vmc.h"

#include "apps/animation/rotation.h"
#include "apps/protocols/osc.h"

namespace mien::protocols {
namespace {

constexpr std::size_t kMaxBytes = 1500;
constexpr std::int32_t kCalibrated = 3, kNormalMode = 0;

std::string message(std::string_view address, std::initializer_list<OscArgument> arguments) {
  return osc_message(address, {arguments.begin(), arguments.size()});
}

float narrow(double value) { return static_cast<float>(value); }

}  // namespace

std::vector<std::string> vmc_packets(const VmcFrame& frame) {
  std::vector<std::string> messages = {
      message("/VMC/Ext/OK", {std::int32_t{1}, kCalibrated, kNormalMode,
                              static_cast<std::int32_t>(frame.tracking)}),
      message("/VMC/Ext/T", {narrow(frame.seconds)})};
  if (frame.head) {
    // Mirrors x, which points to the subject's left in head space and to the right in Unity.
    const auto [x, y, z, w] = animation::quaternion(*frame.head);
    messages.push_back(
        message("/VMC/Ext/Bone/Pos", {std::string_view("Head"), 0.0f, 0.0f, 0.0f, narrow(x),
                                      narrow(-y), narrow(-z), narrow(w)}));
  }
  for (const NamedValue& blend : frame.blends) {
    messages.push_back(message("/VMC/Ext/Blend/Val", {blend.name, narrow(blend.value)}));
  }
  messages.push_back(message("/VMC/Ext/Blend/Apply", {}));
  return osc_bundles(messages, kMaxBytes);
}

}  // namespace mien::protocols
