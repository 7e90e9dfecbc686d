// Writes animations as glTF.
#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>

#include "apps/animation/base64.h"
#include "apps/animation/glb.h"
#include "apps/animation/gltf.h"
#include "apps/animation/gltf_keys.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

constexpr int kHead = 1, kLeftEye = 2, kRightEye = 3, kFace = 4;  // nodes

void put_float(std::string& bytes, double value) {
  put_u32(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

// A list of JSON objects.
class List {
 public:
  std::size_t add(const std::string& object) {
    text_ += (count_ == 0 ? "" : ",") + object;
    return count_++;
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::string text() const { return "[" + text_ + "]"; }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

// The keys of an animated channel, at some of the frames.
class Channel {
 public:
  Channel(int node, const char* path, const char* type) : node_(node), path_(path), type_(type) {}

  void add_key(float second) {
    first_ = keys_ == 0 ? second : first_;
    last_ = second;
    put_float(times_, static_cast<double>(second));
    ++keys_;
  }
  void add_value(double value) { put_float(values_, value); }

  [[nodiscard]] int node() const { return node_; }
  [[nodiscard]] const char* path() const { return path_; }
  [[nodiscard]] const char* type() const { return type_; }
  [[nodiscard]] std::size_t keys() const { return keys_; }
  [[nodiscard]] float first() const { return first_; }
  [[nodiscard]] float last() const { return last_; }
  [[nodiscard]] const std::string& times() const { return times_; }
  [[nodiscard]] const std::string& values() const { return values_; }

 private:
  int node_;
  const char* path_;
  const char* type_;
  std::size_t keys_ = 0;
  float first_ = 0.0f, last_ = 0.0f;
  std::string times_, values_;
};

// Rotations of a node.
class Turns {
 public:
  explicit Turns(int node) : channel(node, "rotation", "VEC4") {}

  void add(float second, const Angles& angles) {
    channel.add_key(second);
    for (const double part : rotations_.next(quaternion(angles))) {
      channel.add_value(part);
    }
  }

  Channel channel;

 private:
  KeyRotations rotations_;
};

class Document {
 public:
  explicit Document(const FrameSequence& frames) {
    Channel weights(kFace, "weights", "SCALAR"), moves(kHead, "translation", "VEC3");
    Turns head(kHead), left(kLeftEye), right(kRightEye);
    KeyTimes times(frames);
    for (const Frame& frame : frames) {
      const std::optional<float> key = times.next(frame);
      if (!key) {
        continue;
      }
      const float second = *key;
      add_weights(frame, second, weights);
      if (frame.head) {
        head.add(second, *frame.head);
      }
      if (frame.position_m) {
        moves.add_key(second);
        for (const double metres : *frame.position_m) {
          moves.add_value(metres);
        }
      }
      if (const auto eyes = frame.eyes ? frame.eyes : gaze(frame.controls)) {
        left.add(second, (*eyes)[0]);
        right.add(second, (*eyes)[1]);
      }
    }
    start_ns_ = frames.empty() ? 0 : frames.first_time_ns();
    for (const Channel* channel :
         {&weights, &head.channel, &moves, &left.channel, &right.channel}) {
      add_channel(*channel);
    }
    add_triangle();
  }

  // `buffer_uri` is empty if the buffer is a chunk of the file.
  [[nodiscard]] std::string json(const std::string& buffer_uri) const {
    std::string names;
    for (const std::string_view name : formats::kArkitNames) {
      names.append(names.empty() ? "\"" : ",\"").append(name).append("\"");
    }
    std::string targets;
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      targets += std::string(i == 0 ? "" : ",") + "{\"POSITION\":" + std::to_string(still_) + "}";
    }
    return "{\"asset\":{\"version\":\"2.0\",\"generator\":\"mien\"},\"scene\":0,"
           "\"scenes\":[{\"nodes\":[0]}],"
           "\"nodes\":[{\"name\":\"root\",\"children\":[1]},"
           "{\"name\":\"head\",\"children\":[2,3,4]},{\"name\":\"leftEye\"},"
           "{\"name\":\"rightEye\"},{\"name\":\"face\",\"mesh\":0}],"
           "\"meshes\":[{\"name\":\"face\",\"primitives\":[{\"attributes\":{\"POSITION\":" +
           std::to_string(corners_) + "},\"targets\":[" + targets + "]}],\"weights\":[" +
           zeros(formats::kControlCount) + "],\"extras\":{\"targetNames\":[" + names + "]}}]," +
           (states_.empty() ? "" : animation()) + "\"accessors\":" + accessors_.text() +
           ",\"bufferViews\":" + views_.text() +
           ",\"buffers\":[{\"byteLength\":" + std::to_string(bytes_.size()) +
           (buffer_uri.empty() ? "" : ",\"uri\":\"" + buffer_uri + "\"") + "}]}";
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void add_weights(const Frame& frame, float second, Channel& weights) {
    states_ += name(frame.state)[0];
    holds_ = holds_ && frame.holds();
    weights.add_key(second);
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      weights.add_value(formats::or_zero(frame.controls[i]));
      driven_[i] = driven_[i] || formats::driven(frame.controls[i]);
    }
  }

  static std::string zeros(std::size_t count) {
    std::string text = "0";
    for (std::size_t i = 1; i < count; ++i) {
      text += ",0";
    }
    return text;
  }

  std::size_t add_accessor(const std::string& data, const char* type, std::size_t count,
                           const std::string& bounds, bool of_vertices) {
    const std::size_t view =
        views_.add("{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
                   ",\"byteLength\":" + std::to_string(data.size()) +
                   (of_vertices ? ",\"target\":34962}" : "}"));
    bytes_ += data;
    return accessors_.add("{\"bufferView\":" + std::to_string(view) +
                          ",\"componentType\":5126,\"type\":\"" + type +
                          "\",\"count\":" + std::to_string(count) + bounds + "}");
  }

  // All digits of the fp32, so that every reader gets the same number.
  static std::string exact(float value) { return shortest(static_cast<double>(value)); }

  void add_channel(const Channel& channel) {
    if (channel.keys() == 0) {
      return;
    }
    const std::size_t components =
        std::string_view(channel.path()) == "weights" ? formats::kControlCount : 1;
    const std::size_t input = add_accessor(
        channel.times(), "SCALAR", channel.keys(),
        ",\"min\":[" + exact(channel.first()) + "],\"max\":[" + exact(channel.last()) + "]", false);
    const std::size_t output =
        add_accessor(channel.values(), channel.type(), channel.keys() * components, "", false);
    const std::size_t sampler = samplers_.add(
        "{\"input\":" + std::to_string(input) + ",\"output\":" + std::to_string(output) +
        ",\"interpolation\":\"" + (holds_ ? "STEP" : "LINEAR") + "\"}");
    channels_.add("{\"sampler\":" + std::to_string(sampler) + ",\"target\":{\"node\":" +
                  std::to_string(channel.node()) + ",\"path\":\"" + channel.path() + "\"}}");
  }

  void add_triangle() {
    std::string corners, still;
    for (const double side : {0.0, 0.0, 0.0, 0.001, 0.0, 0.0, 0.0, 0.001, 0.0}) {
      put_float(corners, side);
      put_float(still, 0.0);
    }
    const std::string millimetre = exact(0.001f);
    corners_ =
        add_accessor(corners, "VEC3", 3,
                     ",\"min\":[0,0,0],\"max\":[" + millimetre + "," + millimetre + ",0]", true);
    still_ = add_accessor(still, "VEC3", 3, ",\"min\":[0,0,0],\"max\":[0,0,0]", true);
  }

  [[nodiscard]] std::string animation() const {
    std::string not_driven;
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      if (!driven_[i]) {
        not_driven.append(not_driven.empty() ? "\"" : ",\"")
            .append(formats::kArkitNames[i])
            .append("\"");
      }
    }
    return "\"animations\":[{\"name\":\"face\",\"channels\":" + channels_.text() +
           ",\"samplers\":" + samplers_.text() +
           ",\"extras\":{\"mien\":{\"start_ns\":" + std::to_string(start_ns_) + ",\"states\":\"" +
           states_ + "\",\"not_driven\":[" + not_driven + "]}}}],";
  }

  std::int64_t start_ns_ = 0;
  std::string states_;  // one letter per key of the weights
  bool holds_ = true;   // for all frames
  std::array<bool, formats::kControlCount> driven_{};
  std::string bytes_;
  List accessors_, views_, samplers_, channels_;
  std::size_t corners_ = 0, still_ = 0;
};

class GltfWriter : public WholeClipWriter {
 public:
  explicit GltfWriter(GltfForm form) : form_(form) {}

 protected:
  std::string whole(const FrameSequence& frames) override {
    const Document document(frames);
    if (form_ == GltfForm::kText) {
      return document.json("data:application/octet-stream;base64," + base64(document.bytes())) +
             "\n";
    }
    return glb_file(document.json(""), document.bytes());
  }

 private:
  GltfForm form_;
};

}  // namespace

std::unique_ptr<AnimationWriter> gltf_writer(GltfForm form) {
  return std::make_unique<GltfWriter>(form);
}

}  // namespace mien::animation
