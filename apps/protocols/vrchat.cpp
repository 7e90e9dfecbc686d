// Computes VRChat's parameters from controls.
#include "apps/protocols/vrchat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <utility>

#include "apps/animation/rotation.h"
#include "apps/protocols/osc.h"

namespace mien::protocols {
namespace {

constexpr std::size_t kMaxBytes = 1500;

using Eyes = std::array<animation::Angles, 2>;  // left, right

// A weighted control of each side, or one control of the whole face.
struct Term {
  std::array<std::uint8_t, 2> controls{};  // left, right
  float weight = 0.0f;
};

consteval bool matches(std::string_view name, std::string_view stem, std::string_view side) {
  return name.size() == stem.size() + side.size() && name.starts_with(stem) && name.ends_with(side);
}

// A name without a side stands for both; other names do not compile.
consteval Term term(std::string_view name, float weight = 1.0f) {
  std::array<std::size_t, 3> found = {formats::kControlCount, formats::kControlCount,
                                      formats::kControlCount};
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    found[0] = matches(formats::kArkitNames[i], name, "Left") ? i : found[0];
    found[1] = matches(formats::kArkitNames[i], name, "Right") ? i : found[1];
    found[2] = formats::kArkitNames[i] == name ? i : found[2];
  }
  const bool exact = found[2] < formats::kControlCount;
  static_cast<void>(formats::kArkitNames.at(exact ? found[2] : std::max(found[0], found[1])));
  return {{static_cast<std::uint8_t>(found[exact ? 2 : 0]),
           static_cast<std::uint8_t>(found[exact ? 2 : 1])},
          weight};
}

// How the parameter without a side follows from those of the left and right side.
enum class Whole : std::uint8_t { kNone, kMean, kMax };

constexpr std::size_t kNameBytes = 24;  // in the table, because pointers take more space

struct SidedParameter {
  char name[kNameBytes];
  Whole whole;
  std::array<Term, 3> terms;
  float offset = 0.0f;
};

struct Parameter {
  char name[kNameBytes];
  std::array<Term, 4> terms;
};

constexpr SidedParameter kSided[] = {
    {"EyeOpen", Whole::kMean, {{term("eyeBlink", -1.0f)}}, 1.0f},
    {"EyeClosed", Whole::kMean, {{term("eyeBlink")}}},
    {"EyeLid", Whole::kMean, {{term("eyeBlink", -0.75f), term("eyeWide", 0.25f)}}, 0.75f},
    {"EyeWide", Whole::kMax, {{term("eyeWide")}}},
    {"EyeSquint", Whole::kMax, {{term("eyeSquint")}}},
    {"BrowPinch", Whole::kNone, {{term("browDown")}}},
    {"BrowLowerer", Whole::kNone, {{term("browDown")}}},
    {"BrowDown", Whole::kMean, {{term("browDown")}}},
    {"BrowInnerUp", Whole::kMean, {{term("browInnerUp")}}},
    {"BrowOuterUp", Whole::kMean, {{term("browOuterUp")}}},
    {"BrowUp", Whole::kMean, {{term("browOuterUp", 0.6f), term("browInnerUp", 0.4f)}}},
    {"BrowExpression",
     Whole::kMean,
     {{term("browInnerUp", 0.5f), term("browOuterUp", 0.5f), term("browDown", -1.0f)}}},
    {"CheekSquint", Whole::kMean, {{term("cheekSquint")}}},
    {"CheekPuff", Whole::kNone, {{term("cheekPuff")}}},
    {"CheekPuffSuck", Whole::kMean, {{term("cheekPuff")}}},
    {"NoseSneer", Whole::kMean, {{term("noseSneer")}}},
    {"Jaw", Whole::kNone, {{term("jaw")}}},
    {"LipSuckUpper", Whole::kMean, {{term("mouthRollUpper")}}},
    {"LipSuckLower", Whole::kMean, {{term("mouthRollLower")}}},
    {"LipFunnelUpper", Whole::kMean, {{term("mouthFunnel")}}},
    {"LipFunnelLower", Whole::kMean, {{term("mouthFunnel")}}},
    {"LipPuckerUpper", Whole::kMean, {{term("mouthPucker")}}},
    {"LipPuckerLower", Whole::kMean, {{term("mouthPucker")}}},
    {"LipPucker", Whole::kMean, {{term("mouthPucker")}}},
    {"LipSuckFunnelUpper", Whole::kMean, {{term("mouthRollUpper"), term("mouthFunnel", -1.0f)}}},
    {"LipSuckFunnelLower", Whole::kMean, {{term("mouthRollLower"), term("mouthFunnel", -1.0f)}}},
    {"MouthUpperUp", Whole::kMean, {{term("mouthUpperUp")}}},
    {"MouthUpperDeepen", Whole::kNone, {{term("mouthUpperUp")}}},
    {"MouthLowerDown", Whole::kMean, {{term("mouthLowerDown")}}},
    {"MouthUpper", Whole::kNone, {{term("mouth")}}},
    {"MouthLower", Whole::kNone, {{term("mouth")}}},
    {"MouthCornerPull", Whole::kNone, {{term("mouthSmile")}}},
    {"MouthCornerSlant", Whole::kNone, {{term("mouthSmile")}}},
    {"MouthCornerY", Whole::kMean, {{term("mouthSmile"), term("mouthFrown", -1.0f)}}},
    {"MouthSmile", Whole::kNone, {{term("mouthSmile")}}},
    {"MouthFrown", Whole::kNone, {{term("mouthFrown")}}},
    {"SmileFrown", Whole::kMean, {{term("mouthSmile"), term("mouthFrown", -1.0f)}}},
    {"MouthStretch", Whole::kMean, {{term("mouthStretch")}}},
    {"MouthTightenerStretch", Whole::kMean, {{term("mouthStretch", -1.0f)}}},
    {"MouthDimple", Whole::kMean, {{term("mouthDimple")}}},
    {"MouthPress", Whole::kMean, {{term("mouthPress")}}},
};

constexpr Parameter kWhole[] = {
    {"JawOpen", {{term("jawOpen")}}},
    {"JawForward", {{term("jawForward")}}},
    {"JawX", {{term("jawRight"), term("jawLeft", -1.0f)}}},
    {"JawZ", {{term("jawForward")}}},
    {"MouthClosed", {{term("mouthClose")}}},
    {"MouthX", {{term("mouthRight"), term("mouthLeft", -1.0f)}}},
    {"MouthUpperX", {{term("mouthRight"), term("mouthLeft", -1.0f)}}},
    {"MouthLowerX", {{term("mouthRight"), term("mouthLeft", -1.0f)}}},
    {"MouthOpen",
     {{term("mouthUpperUpLeft", 0.25f), term("mouthUpperUpRight", 0.25f),
       term("mouthLowerDownLeft", 0.25f), term("mouthLowerDownRight", 0.25f)}}},
    {"MouthRaiserUpper", {{term("mouthShrugUpper")}}},
    {"MouthRaiserLower", {{term("mouthShrugLower")}}},
    {"LipSuck", {{term("mouthRollUpper", 0.5f), term("mouthRollLower", 0.5f)}}},
    {"LipFunnel", {{term("mouthFunnel")}}},
    {"TongueOut", {{term("tongueOut")}}},
};

class Parameters {
 public:
  explicit Parameters(const animation::Frame& frame) : frame_(frame) {}

  void add_expressions() {
    for (const SidedParameter& parameter : kSided) {
      add_sides(parameter.name, "", parameter.whole, [&](std::size_t side) {
        return double{parameter.offset} + sum(parameter.terms, side);
      });
    }
    for (const Parameter& parameter : kWhole) {
      add(parameter.name, "", "", sum(parameter.terms, 0));
    }
    add_sides("MouthSad", "", Whole::kNone, [&](std::size_t side) { return sad(side); });
    add_sides("SmileSad", "", Whole::kMean, [&](std::size_t side) {
      const double smile = value(term("mouthSmile"), side), frown = sad(side);
      return formats::driven(smile) || formats::driven(frown)
                 ? formats::or_zero(smile) - formats::or_zero(frown)
                 : formats::kNoNumber;
    });
  }

  void add_gaze() {
    const std::optional<Eyes> eyes = animation::gaze(frame_.controls);
    if (eyes) {
      add_sides("Eye", "X", Whole::kMean,
                [&](std::size_t side) { return -std::tan((*eyes)[side].yaw); });
      add_sides("Eye", "Y", Whole::kMean,
                [&](std::size_t side) { return -std::tan((*eyes)[side].pitch); });
    }
  }

  [[nodiscard]] std::vector<VrchatParameter> take() { return std::move(parameters_); }

 private:
  [[nodiscard]] double value(const Term& term, std::size_t side) const {
    return frame_.controls[term.controls[side]];
  }

  [[nodiscard]] double sad(std::size_t side) const {
    const double frown = value(term("mouthFrown"), side);
    const double stretch = value(term("mouthStretch"), side);
    return std::fmax(frown, stretch);  // the other one if one is NaN
  }

  // Unsupported controls count as 0; the result is NaN if all are.
  template <std::size_t count>
  [[nodiscard]] double sum(const std::array<Term, count>& terms, std::size_t side) const {
    double total = 0.0;
    bool any = false;
    for (const Term& term : terms) {
      const double control = value(term, side);
      any = any || (term.weight != 0.0f && formats::driven(control));
      total += double{term.weight} * formats::or_zero(control);
    }
    return any ? total : formats::kNoNumber;
  }

  void add(std::string_view name, std::string_view side, std::string_view axis, double value) {
    if (formats::driven(value)) {
      parameters_.push_back({std::string(name).append(side).append(axis), value});
    }
  }

  template <class Value>
  void add_sides(std::string_view name, std::string_view axis, Whole whole, const Value& value) {
    const std::array<double, 2> values = {value(0), value(1)};
    add(name, "Left", axis, values[0]);
    add(name, "Right", axis, values[1]);
    const double sum = values[0] + values[1];  // NaN if one is
    if (whole != Whole::kNone && formats::driven(sum)) {
      add(name, "", axis, whole == Whole::kMax ? std::max(values[0], values[1]) : 0.5 * sum);
    }
  }

  const animation::Frame& frame_;
  std::vector<VrchatParameter> parameters_;
};

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string message(std::string_view address, std::initializer_list<OscArgument> arguments) {
  return osc_message(address, {arguments.begin(), arguments.size()});
}

float degrees(double radians) { return static_cast<float>(kDegrees * radians); }

void add_native_eyes(const animation::Frame& frame, std::vector<std::string>& messages) {
  if (const std::optional<Eyes> eyes = animation::gaze(frame.controls)) {
    const auto [left, right] = *eyes;
    messages.push_back(message("/tracking/eye/LeftRightPitchYaw",
                               {degrees(left.pitch), degrees(0.0 - left.yaw), degrees(right.pitch),
                                degrees(0.0 - right.yaw)}));
  }
  const double closed = 0.5 * (frame.controls[formats::control("eyeBlinkLeft")] +
                               frame.controls[formats::control("eyeBlinkRight")]);
  if (formats::driven(closed)) {
    messages.push_back(message("/tracking/eye/EyesClosedAmount", {static_cast<float>(closed)}));
  }
}

}  // namespace

std::vector<VrchatParameter> vrchat_parameters(const animation::Frame& frame) {
  Parameters parameters(frame);
  parameters.add_expressions();
  parameters.add_gaze();
  return parameters.take();
}

std::vector<std::string> vrchat_packets(const animation::Frame& frame,
                                        const VrchatOptions& options) {
  constexpr std::string_view kAvatar = "/avatar/parameters/";
  std::vector<std::string> messages;
  const bool tracking = frame.state == animation::FaceState::kTracking;
  for (const std::string_view name :
       {"EyeTrackingActive", "ExpressionTrackingActive", "LipTrackingActive"}) {
    messages.push_back(message(std::string(kAvatar).append(name), {tracking}));
  }
  const std::string path = std::string(kAvatar).append(options.prefix).append("v2/");
  for (const VrchatParameter& parameter : vrchat_parameters(frame)) {
    messages.push_back(message(path + parameter.name, {static_cast<float>(parameter.value)}));
  }
  if (options.native_eyes && tracking) {
    add_native_eyes(frame, messages);
  }
  return osc_bundles(messages, kMaxBytes);
}

}  // namespace mien::protocols
