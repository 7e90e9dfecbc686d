// Reads and writes JSON lines.
#include "apps/animation/frames_jsonl.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "apps/animation/json.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

using Kind = JsonValue::Kind;

template <class Values>
std::string json_array(const Values& values) {
  std::string text = "[";
  for (const double value : values) {
    text.append(text.size() > 1 ? "," : "").append(shortest(value));
  }
  return text + "]";
}

std::string json_angles(const Angles& angles) {
  return "\"pitch_rad\":" + shortest(angles.pitch) + ",\"yaw_rad\":" + shortest(angles.yaw) +
         ",\"roll_rad\":" + shortest(angles.roll);
}

// Supported controls by name.
std::string json_weights(std::span<const double> values, std::span<const std::string_view> names) {
  std::string text = "{";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (formats::driven(values[i])) {
      text.append(text.size() > 1 ? "," : "").append("\"").append(names[i]).append("\":");
      text.append(shortest(values[i]));
    }
  }
  return text + "}";
}

class FramesJsonlWriter : public AnimationWriter {
 public:
  std::string frame(const Frame& frame) override { return frame_json(frame) + "\n"; }
};

// Reads the object of a line.
class ObjectReader {
 public:
  ObjectReader(const JsonValue& object, Fault& fault) : object_(object), fault_(fault) {}

  bool read(Frame& frame) {
    return read_time(frame.time_ns) && read_integer("frame", frame.number) &&
           read_integer("face_id", frame.face_id) && read_integer("lod", frame.lod) &&
           read_state(frame.state) && read_fraction("face_prob", frame.face_probability) &&
           read_fraction("vad", frame.voice_activity) && read_array("box", frame.box) &&
           read_angles(object_.find("head"), frame.head) &&
           read_array("position_m", frame.position_m) && read_eyes(frame) &&
           read_weights("controls", formats::kArkitNames, frame.controls) &&
           read_list("facs", formats::kFacsNames, frame.facs) &&
           read_list("visemes", formats::kVisemeNames, frame.visemes) &&
           read_shape(frame.mouth_shape);
  }

 private:
  bool read_time(std::int64_t& time_ns) {
    const std::optional<JsonValue> found = object_.find("t_ns");
    if (!found) {
      return object_.fail_here("t_ns: missing", fault_);
    }
    return read_integer("t_ns", time_ns) &&
           (time_allowed(time_ns) || found->fail_here("t_ns: out of range", fault_));
  }

  bool read_integer(std::string_view key, std::int64_t& value) {
    const std::optional<JsonValue> found = object_.find(key);
    return !found || found->integer(value) ||
           found->fail_here(std::string(key) + ": expected an integer", fault_);
  }

  bool read_fraction(std::string_view key, double& value) {
    const std::optional<JsonValue> found = object_.find(key);
    return !found || parse_fraction(*found, key, value);
  }

  bool parse_fraction(const JsonValue& found, std::string_view key, double& value) {
    if (!found.is(Kind::kNumber) || found.number() < 0.0 || found.number() > 1.0) {
      return found.fail_here(std::string(key) + ": expected a number in 0..1", fault_);
    }
    value = found.number();
    return true;
  }

  bool read_state(FaceState& state) {
    const std::optional<JsonValue> found = object_.find("status");
    if (!found) {
      return true;
    }
    for (const FaceState candidate :
         {FaceState::kSearching, FaceState::kTracking, FaceState::kLost}) {
      if (found->is(Kind::kString) && found->text() == name(candidate)) {
        state = candidate;
        return true;
      }
    }
    return found->fail_here("status: expected searching, tracking or lost", fault_);
  }

  template <std::size_t N>
  bool read_array(std::string_view key, std::optional<std::array<double, N>>& values) {
    const std::optional<JsonValue> found = object_.find(key);
    if (!found) {
      return true;
    }
    std::array<double, N> read{};
    std::size_t count = 0;
    bool good = found->is(Kind::kArray);
    for (const JsonValue item : found->items()) {
      good = good && count < N && item.is(Kind::kNumber);
      if (!good) {
        break;
      }
      read[count++] = item.number();
    }
    if (!good || count != N) {
      return found->fail_here(std::string(key) + ": expected " + std::to_string(N) + " numbers",
                              fault_);
    }
    values = read;
    return true;
  }

  bool read_angles(const std::optional<JsonValue>& found, std::optional<Angles>& angles) {
    if (!found) {
      return true;
    }
    Angles read;
    double* const parts[] = {&read.pitch, &read.yaw, &read.roll};
    constexpr std::string_view kKeys[] = {"pitch_rad", "yaw_rad", "roll_rad"};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<JsonValue> part = found->find(kKeys[i]);
      if (!part || !part->is(Kind::kNumber)) {
        return found->fail_here("pitch_rad, yaw_rad and roll_rad are required", fault_);
      }
      *parts[i] = part->number();
    }
    angles = read;
    return true;
  }

  bool read_eyes(Frame& frame) {
    const std::optional<JsonValue> found = object_.find("eyes");
    if (!found) {
      return true;
    }
    std::optional<Angles> left, right;
    if (!read_angles(found->find("left"), left) || !read_angles(found->find("right"), right)) {
      return false;
    }
    if (!left || !right) {
      return found->fail_here("eyes: left and right are required", fault_);
    }
    frame.eyes = {*left, *right};
    return true;
  }

  template <std::size_t N, class Values>
  bool read_weights(std::string_view key, const std::array<std::string_view, N>& names,
                    Values& values) {
    const std::optional<JsonValue> found = object_.find(key);
    if (!found) {
      return true;
    }
    if (!found->is(Kind::kObject)) {
      return found->fail_here(std::string(key) + ": expected an object", fault_);
    }
    const JsonValue::Items members = found->items();
    for (auto at = members.begin(); at != members.end(); ++at) {
      const std::string name = at.key().text();
      const std::size_t which = formats::index_of(name, names);
      if (which == N) {
        return (*at).fail_here(std::string(key) + ": unknown name " + quoted(name), fault_);
      }
      if (!parse_fraction(*at, name, values[which])) {
        return false;
      }
    }
    return true;
  }

  template <std::size_t N>
  bool read_list(std::string_view key, const std::array<std::string_view, N>& names,
                 std::vector<double>& values) {
    if (!object_.find(key)) {
      return true;
    }
    values.assign(N, formats::kNoNumber);
    return read_weights(key, names, values);
  }

  bool read_shape(char& shape) {
    const std::optional<JsonValue> found = object_.find("mouth_shape");
    if (!found) {
      return true;
    }
    const std::string text = found->text();
    if (text.size() != 1 || formats::kMouthShapes.find(text[0]) == formats::kMouthShapes.npos) {
      return found->fail_here("mouth_shape: expected A to H or X", fault_);
    }
    shape = text[0];
    return true;
  }

  JsonValue object_;
  Fault& fault_;
};

bool read_object(const JsonValue& object, Frame& frame, Fault& fault) {
  return object.is(Kind::kObject) ? ObjectReader(object, fault).read(frame)
                                  : object.fail_here("expected an object", fault);
}

}  // namespace

std::string frame_json(const Frame& frame) {
  std::string text = "{\"t_ns\":" + std::to_string(frame.time_ns) +
                     ",\"frame\":" + std::to_string(frame.number) + ",\"status\":\"" +
                     name(frame.state) + "\",\"face_id\":" + std::to_string(frame.face_id);
  const auto member = [&text](const char* key, const std::string& value) {
    text.append(",\"").append(key).append("\":").append(value);
  };
  if (formats::driven(frame.face_probability)) {
    member("face_prob", shortest(frame.face_probability));
  }
  if (frame.lod != 0) {
    member("lod", std::to_string(frame.lod));
  }
  if (formats::driven(frame.voice_activity)) {
    member("vad", shortest(frame.voice_activity));
  }
  if (frame.box) {
    member("box", json_array(*frame.box));
  }
  if (frame.head) {
    member("head", std::string("{") + json_angles(*frame.head) +
                       ",\"q\":" + json_array(quaternion(*frame.head)) + "}");
  }
  if (frame.position_m) {
    member("position_m", json_array(*frame.position_m));
  }
  if (frame.eyes) {
    member("eyes", "{\"left\":{" + json_angles((*frame.eyes)[0]) + "},\"right\":{" +
                       json_angles((*frame.eyes)[1]) + "}}");
  }
  member("controls", json_weights(frame.controls, formats::kArkitNames));
  if (!frame.facs.empty()) {
    member("facs", json_weights(frame.facs, formats::kFacsNames));
  }
  if (!frame.visemes.empty()) {
    member("visemes", json_weights(frame.visemes, formats::kVisemeNames));
  }
  if (frame.mouth_shape != 0) {
    member("mouth_shape", std::string("\"") + frame.mouth_shape + "\"");
  }
  return text + "}";
}

std::unique_ptr<AnimationWriter> frames_jsonl_writer() {
  return std::make_unique<FramesJsonlWriter>();
}

bool read_frames_jsonl(std::string_view text, Clip& clip, Fault& fault) {
  Clip read;
  read.frames.limit_bytes(max_clip_bytes(text.size()));
  JsonDocument document;
  std::size_t line = 0;
  while (!text.empty()) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(row.size() + 1, text.size()));
    ++line;
    if (row.find_first_not_of(" \t\r") == std::string_view::npos) {
      continue;
    }
    Frame frame;
    frame.number = static_cast<std::int64_t>(read.frames.size());
    if (!document.parse(row, fault, line) || !read_object(document.root(), frame, fault)) {
      return false;
    }
    if (!read.frames.empty() && frame.time_ns < read.frames.last_time_ns()) {
      return document.root().find("t_ns")->fail_here("t_ns: decreasing time", fault);
    }
    if (!add_frame(read, frame, line, fault)) {
      return false;
    }
  }
  if (read.frames.empty()) {
    return fail(fault, line + 1, 1, "no frames");
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::animation
