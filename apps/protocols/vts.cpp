// Writes requests to VTube Studio, and parses its answers.
#include "apps/protocols/vts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/animation/json.h"
#include "apps/animation/numbers.h"

namespace mien::protocols {
namespace {

using animation::json_string;
using animation::JsonValue;
using formats::control;

constexpr std::string_view kPlugin = R"("pluginName":"mien","pluginDeveloper":"mien")";
constexpr std::string_view kStateId = "state", kTokenId = "token";
constexpr std::string_view kAuthenticationId = "authentication", kInjectionId = "injection";
constexpr std::size_t kMaxReasonBytes = 200;
constexpr double kDegrees = 180.0 / std::numbers::pi, kCentimetres = 100.0;

std::string request(std::string_view type, std::string_view id, std::string_view data) {
  return std::string(R"({"apiName":"VTubeStudioPublicAPI","apiVersion":"1.0","requestID":")")
      .append(id)
      .append(R"(","messageType":")")
      .append(type)
      .append(R"(Request","data":{)")
      .append(data)
      .append("}}");
}

class Values {
 public:
  explicit Values(const animation::Frame& frame) : frame_(frame) {}

  struct Term {
    std::size_t control;
    double weight;
  };

  void add(const char* name, double value) { values_.push_back({name, value}); }

  // Clamped to low..high.
  void add(const char* name, double low, double high, double offset,
           std::initializer_list<Term> terms) {
    bool any = false;
    for (const Term& term : terms) {
      any = any || formats::driven(frame_.controls[term.control]);
      offset += term.weight * formats::or_zero(frame_.controls[term.control]);
    }
    if (any) {
      add(name, std::clamp(offset, low, high));
    }
  }

  [[nodiscard]] std::vector<VtsParameter> take() { return std::move(values_); }

 private:
  const animation::Frame& frame_;
  std::vector<VtsParameter> values_;
};

void add_head(const animation::Frame& frame, Values& values) {
  if (frame.head) {
    values.add("FaceAngleX", -kDegrees * frame.head->yaw);
    values.add("FaceAngleY", -kDegrees * frame.head->pitch);
    values.add("FaceAngleZ", kDegrees * frame.head->roll);
  }
  if (frame.position_m) {
    values.add("FacePositionX", -kCentimetres * (*frame.position_m)[0]);
    values.add("FacePositionY", kCentimetres * (*frame.position_m)[1]);
  }
}

void add_eyes(Values& values) {
  values.add("EyeOpenLeft", 0.0, 1.0, 1.0, {{control("eyeBlinkLeft"), -1.0}});
  values.add("EyeOpenRight", 0.0, 1.0, 1.0, {{control("eyeBlinkRight"), -1.0}});
  values.add("EyeLeftX", -1.0, 1.0, 0.0,
             {{control("eyeLookInLeft"), 1.0}, {control("eyeLookOutLeft"), -1.0}});
  values.add("EyeLeftY", -1.0, 1.0, 0.0,
             {{control("eyeLookUpLeft"), 1.0}, {control("eyeLookDownLeft"), -1.0}});
  values.add("EyeRightX", -1.0, 1.0, 0.0,
             {{control("eyeLookOutRight"), 1.0}, {control("eyeLookInRight"), -1.0}});
  values.add("EyeRightY", -1.0, 1.0, 0.0,
             {{control("eyeLookUpRight"), 1.0}, {control("eyeLookDownRight"), -1.0}});
}

void add_brows(Values& values) {
  constexpr std::size_t kInner = control("browInnerUp");
  values.add("BrowLeftY", 0.0, 1.0, 0.5,
             {{kInner, 0.25}, {control("browOuterUpLeft"), 0.25}, {control("browDownLeft"), -0.5}});
  values.add(
      "BrowRightY", 0.0, 1.0, 0.5,
      {{kInner, 0.25}, {control("browOuterUpRight"), 0.25}, {control("browDownRight"), -0.5}});
  values.add("Brows", 0.0, 1.0, 0.5,
             {{kInner, 0.25},
              {control("browOuterUpLeft"), 0.125},
              {control("browOuterUpRight"), 0.125},
              {control("browDownLeft"), -0.25},
              {control("browDownRight"), -0.25}});
}

void add_mouth(Values& values) {
  values.add("MouthOpen", 0.0, 1.0, 0.0,
             {{control("jawOpen"), 1.0}, {control("mouthClose"), -1.0}});
  values.add("MouthSmile", 0.0, 1.0, 0.5,
             {{control("mouthSmileLeft"), 0.25},
              {control("mouthSmileRight"), 0.25},
              {control("mouthFrownLeft"), -0.25},
              {control("mouthFrownRight"), -0.25}});
  values.add("MouthX", -1.0, 1.0, 0.0,
             {{control("mouthLeft"), 1.0}, {control("mouthRight"), -1.0}});
  values.add("CheekPuff", 0.0, 1.0, 0.0, {{control("cheekPuff"), 1.0}});
  values.add("TongueOut", 0.0, 1.0, 0.0, {{control("tongueOut"), 1.0}});
}

struct Response {
  std::string_view type;
  VtsAnswerKind kind;
};

constexpr std::array<Response, 6> kResponses = {{
    {"APIStateResponse", VtsAnswerKind::kState},
    {"AuthenticationTokenResponse", VtsAnswerKind::kToken},
    {"AuthenticationResponse", VtsAnswerKind::kAuthentication},
    {"ParameterCreationResponse", VtsAnswerKind::kCreation},
    {"InjectParameterDataResponse", VtsAnswerKind::kInjection},
    {"APIError", VtsAnswerKind::kError},
}};

VtsAnswerKind kind_of(std::string_view type) {
  const auto* found = std::find_if(kResponses.begin(), kResponses.end(),
                                   [type](const Response& known) { return known.type == type; });
  return found == kResponses.end() ? VtsAnswerKind::kOther : found->kind;
}

std::optional<VtsAnswer> refuse(const char* what, std::string& fault) {
  fault = what;
  return std::nullopt;
}

std::string text_of(const std::optional<JsonValue>& object, std::string_view key) {
  const std::optional<JsonValue> value = object ? object->find(key) : std::nullopt;
  return value ? value->text() : "";
}

// At most kMaxReasonBytes, without a part of a character.
std::string shortened(std::string text) {
  if (text.size() > kMaxReasonBytes) {
    std::size_t end = kMaxReasonBytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) {
      --end;
    }
    text.resize(end);
  }
  return text;
}

}  // namespace

std::vector<VtsParameter> vts_parameters(const animation::Frame& frame) {
  Values values(frame);
  add_head(frame, values);
  add_eyes(values);
  add_brows(values);
  add_mouth(values);
  return values.take();
}

std::string vts_custom_name(std::size_t index) {
  if (index == control("cheekPuff") || index == control("tongueOut")) {
    return "";
  }
  std::string name = std::string("Mien").append(formats::kArkitNames[index]);
  name[4] = static_cast<char>(name[4] - 'a' + 'A');
  return name;
}

std::string vts_state_request() { return request("APIState", kStateId, ""); }

std::string vts_token_request() { return request("AuthenticationToken", kTokenId, kPlugin); }

std::string vts_authentication_request(std::string_view token) {
  return request("Authentication", kAuthenticationId,
                 std::string(kPlugin).append(R"(,"authenticationToken":)") + json_string(token));
}

std::string vts_creation_request(std::size_t index) {
  const std::string_view name = formats::kArkitNames[index];
  return request("ParameterCreation", name,
                 R"("parameterName":")" + vts_custom_name(index) + R"(","explanation":"ARKit's )" +
                     std::string(name) + R"(, 0 to 1","min":0,"max":1,"defaultValue":0)");
}

std::string vts_injection_request(const animation::Frame& frame, const VtsControls& custom) {
  std::vector<VtsParameter> values = vts_parameters(frame);
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    const std::string name = vts_custom_name(i);
    if (custom[i] && !name.empty() && formats::driven(frame.controls[i])) {
      values.push_back({name, frame.controls[i]});
    }
  }
  std::string list;
  for (const VtsParameter& parameter : values) {
    list.append(list.empty() ? R"({"id":")" : R"(,{"id":")")
        .append(parameter.name)
        .append(R"(","value":)")
        .append(animation::shortest(parameter.value))
        .append("}");
  }
  if (list.empty()) {
    return "";
  }
  const bool found = frame.state == animation::FaceState::kTracking;
  return request("InjectParameterData", kInjectionId,
                 std::string(R"("faceFound":)")
                     .append(found ? "true" : "false")
                     .append(R"(,"mode":"set","parameterValues":[)")
                     .append(list)
                     .append("]"));
}

bool is_vts_token(std::string_view text) {
  return !text.empty() && text.size() <= kVtsMaxTokenBytes &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

std::optional<VtsAnswer> parse_vts_answer(std::string_view text, std::string& fault) {
  animation::JsonDocument document;
  animation::Fault where;
  if (!document.parse(text, where)) {
    return refuse("answer: invalid JSON", fault);
  }
  if (text_of(document.root(), "apiName") != "VTubeStudioPublicAPI") {
    return refuse("answer: not from VTube Studio", fault);
  }
  VtsAnswer answer;
  answer.kind = kind_of(text_of(document.root(), "messageType"));
  answer.request = shortened(text_of(document.root(), "requestID"));
  const std::optional<JsonValue> data = document.root().find("data");
  if (answer.kind == VtsAnswerKind::kToken) {
    answer.token = text_of(data, "authenticationToken");
    if (!is_vts_token(answer.token)) {
      return refuse("answer: invalid token", fault);
    }
  } else if (answer.kind == VtsAnswerKind::kAuthentication) {
    const std::optional<JsonValue> done = data ? data->find("authenticated") : std::nullopt;
    answer.authenticated = done && done->truth();
    answer.reason = shortened(text_of(data, "reason"));
  } else if (answer.kind == VtsAnswerKind::kError) {
    const std::optional<JsonValue> id = data ? data->find("errorID") : std::nullopt;
    static_cast<void>(id && id->integer(answer.error));
    answer.reason = shortened(text_of(data, "message"));
  }
  return answer;
}

}  // namespace mien::protocols
