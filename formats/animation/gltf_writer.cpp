#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "formats/animation/base64.h"
#include "formats/animation/gltf.h"
#include "formats/animation/numbers.h"
#include "formats/animation/rotation.h"

namespace mien::formats {
namespace {

constexpr int kHead = 1, kLeftEye = 2, kRightEye = 3, kFace = 4;  // nodes

void put_u32(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) {
    bytes += static_cast<char>(value >> (8 * i) & 255);
  }
}

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

class Document {
 public:
  explicit Document(const std::vector<Frame>& frames) {
    keep_later_ones(frames);
    if (!frames_.empty()) {
      add_weights();
      add_turns(kHead, [](const Frame& frame) { return frame.head; });
      add_moves();
      for (std::size_t eye = 0; eye < 2; ++eye) {
        add_turns(eye == 0 ? kLeftEye : kRightEye, [eye](const Frame& frame) {
          const auto eyes = frame.eyes ? frame.eyes : gaze(frame.controls);
          return eyes ? std::optional((*eyes)[eye]) : std::nullopt;
        });
      }
    }
    add_triangle();
  }

  // `buffer_uri` is empty where the buffer is a chunk of the file.
  [[nodiscard]] std::string json(const std::string& buffer_uri) const {
    std::string names;
    for (const std::string_view name : kArkitNames) {
      names.append(names.empty() ? "\"" : ",\"").append(name).append("\"");
    }
    std::string targets;
    for (std::size_t i = 0; i < kControlCount; ++i) {
      targets += std::string(i == 0 ? "" : ",") + "{\"POSITION\":" + std::to_string(still_) + "}";
    }
    return "{\"asset\":{\"version\":\"2.0\",\"generator\":\"mien\"},\"scene\":0,"
           "\"scenes\":[{\"nodes\":[0]}],"
           "\"nodes\":[{\"name\":\"root\",\"children\":[1]},"
           "{\"name\":\"head\",\"children\":[2,3,4]},{\"name\":\"leftEye\"},"
           "{\"name\":\"rightEye\"},{\"name\":\"face\",\"mesh\":0}],"
           "\"meshes\":[{\"name\":\"face\",\"primitives\":[{\"attributes\":{\"POSITION\":" +
           std::to_string(corners_) + "},\"targets\":[" + targets + "]}],\"weights\":[" +
           zeros(kControlCount) + "],\"extras\":{\"targetNames\":[" + names + "]}}]," +
           (frames_.empty() ? "" : animation()) + "\"accessors\":" + accessors_.text() +
           ",\"bufferViews\":" + views_.text() +
           ",\"buffers\":[{\"byteLength\":" + std::to_string(bytes_.size()) +
           (buffer_uri.empty() ? "" : ",\"uri\":\"" + buffer_uri + "\"") + "}]}";
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  // Keys have to ascend, as fp32.
  void keep_later_ones(const std::vector<Frame>& frames) {
    for (const Frame& frame : frames) {
      const std::int64_t since = frame.time_ns - frames.front().time_ns;
      const auto second = static_cast<float>(static_cast<double>(since) * 1e-9);
      if (frames_.empty() || second > seconds_.back()) {
        frames_.push_back(&frame);
        seconds_.push_back(second);
      }
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

  std::size_t add_times(const std::vector<std::size_t>& keys) {
    std::string data;
    for (const std::size_t key : keys) {
      put_float(data, static_cast<double>(seconds_[key]));
    }
    return add_accessor(data, "SCALAR", keys.size(),
                        ",\"min\":[" + exact(seconds_[keys.front()]) + "],\"max\":[" +
                            exact(seconds_[keys.back()]) + "]",
                        false);
  }

  // All digits of the fp32, so that it is the same number whoever reads it.
  static std::string exact(float value) { return shortest(static_cast<double>(value)); }

  void add_channel(int node, const char* path, std::size_t input, std::size_t output) {
    const std::size_t sampler =
        samplers_.add("{\"input\":" + std::to_string(input) +
                      ",\"output\":" + std::to_string(output) + ",\"interpolation\":\"LINEAR\"}");
    channels_.add("{\"sampler\":" + std::to_string(sampler) +
                  ",\"target\":{\"node\":" + std::to_string(node) + ",\"path\":\"" + path + "\"}}");
  }

  void add_weights() {
    std::vector<std::size_t> keys(frames_.size());
    std::string data;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      keys[i] = i;
      for (const double value : frames_[i]->controls) {
        put_float(data, or_zero(value));
      }
    }
    const std::size_t times = add_times(keys);
    add_channel(kFace, "weights", times,
                add_accessor(data, "SCALAR", frames_.size() * kControlCount, "", false));
  }

  template <class Get>
  void add_turns(int node, const Get& get) {
    std::vector<std::size_t> keys;
    std::string data;
    Quaternion before = {0.0, 0.0, 0.0, 1.0};
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const std::optional<Angles> angles = get(*frames_[i]);
      if (!angles) {
        continue;
      }
      Quaternion turn = quaternion(*angles);
      double same_way = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        same_way += turn[k] * before[k];
      }
      for (double& part : turn) {
        part = same_way < 0.0 ? -part : part;  // the shorter way from key to key
        put_float(data, part);
      }
      before = turn;
      keys.push_back(i);
    }
    if (!keys.empty()) {
      const std::size_t times = add_times(keys);
      add_channel(node, "rotation", times, add_accessor(data, "VEC4", keys.size(), "", false));
    }
  }

  void add_moves() {
    std::vector<std::size_t> keys;
    std::string data;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (frames_[i]->position_m) {
        keys.push_back(i);
        for (const double metres : *frames_[i]->position_m) {
          put_float(data, metres);
        }
      }
    }
    if (!keys.empty()) {
      const std::size_t times = add_times(keys);
      add_channel(kHead, "translation", times, add_accessor(data, "VEC3", keys.size(), "", false));
    }
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
    std::string states, not_driven;
    for (const Frame* frame : frames_) {
      states += name(frame->state)[0];
    }
    for (std::size_t i = 0; i < kControlCount; ++i) {
      if (std::none_of(frames_.begin(), frames_.end(),
                       [i](const Frame* frame) { return driven(frame->controls[i]); })) {
        not_driven.append(not_driven.empty() ? "\"" : ",\"").append(kArkitNames[i]).append("\"");
      }
    }
    return "\"animations\":[{\"name\":\"face\",\"channels\":" + channels_.text() +
           ",\"samplers\":" + samplers_.text() +
           ",\"extras\":{\"mien\":{\"start_ns\":" + std::to_string(frames_.front()->time_ns) +
           ",\"states\":\"" + states + "\",\"not_driven\":[" + not_driven + "]}}}],";
  }

  std::vector<const Frame*> frames_;
  std::vector<float> seconds_;
  std::string bytes_;
  List accessors_, views_, samplers_, channels_;
  std::size_t corners_ = 0, still_ = 0;
};

void pad(std::string& text, char with) {
  while (text.size() % 4 != 0) {
    text += with;
  }
}

class GltfWriter : public WholeClipWriter {
 public:
  explicit GltfWriter(GltfForm form) : form_(form) {}

 protected:
  std::string whole(const std::vector<Frame>& frames) override {
    const Document document(frames);
    if (form_ == GltfForm::kText) {
      return document.json("data:application/octet-stream;base64," + base64(document.bytes())) +
             "\n";
    }
    constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;
    std::string json = document.json(""), data = document.bytes();
    pad(json, ' ');
    pad(data, '\0');
    std::string file = "glTF";
    put_u32(file, 2);
    put_u32(file, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + data.size()));
    put_u32(file, static_cast<std::uint32_t>(json.size()));
    put_u32(file, kJson);
    file += json;
    put_u32(file, static_cast<std::uint32_t>(data.size()));
    put_u32(file, kBin);
    return file + data;
  }

 private:
  GltfForm form_;
};

}  // namespace

std::unique_ptr<AnimationWriter> gltf_writer(GltfForm form) {
  return std::make_unique<GltfWriter>(form);
}

}  // namespace mien::formats
