// Writes animations as glTF.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/avatar_model.h"
#include "apps/animation/base64.h"
#include "apps/animation/glb.h"
#include "apps/animation/gltf.h"
#include "apps/animation/gltf_keys.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

constexpr int kHead = 1, kLeftEye = 2, kRightEye = 3, kFace = 4, kBody = 5;  // nodes
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedByte = 5121;
constexpr int kVertices = 34962, kIndices = 34963;  // targets of buffer views

void put_float(std::string& bytes, double value) {
  put_u32(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void put_short(std::string& bytes, std::uint16_t value) {
  bytes += static_cast<char>(value & 255);
  bytes += static_cast<char>(value >> 8);
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
    const AvatarModel model = avatar_model();
    for (const auto& target : model.targets) {
      targets_.add("{\"POSITION\":" + std::to_string(add_target(target)) + "}");
    }
    add_mesh("face", model.face);
    add_mesh("body", model.body);
    add_mesh("eye", model.eye);
    eyes_ = model.eye_centres;
  }

  // `buffer_uri` is empty if the buffer is a chunk of the file.
  [[nodiscard]] std::string json(const std::string& buffer_uri) const {
    std::string names;
    for (const std::string_view name : formats::kArkitNames) {
      names.append(names.empty() ? "\"" : ",\"").append(name).append("\"");
    }
    return "{\"asset\":{\"version\":\"2.0\",\"generator\":\"mien\"},\"scene\":0,"
           "\"scenes\":[{\"nodes\":[0]}],"
           "\"nodes\":[{\"name\":\"root\",\"children\":[1,5]},"
           "{\"name\":\"head\",\"children\":[2,3,4]},{\"name\":\"leftEye\"," +
           eye(0) + "},{\"name\":\"rightEye\"," + eye(1) +
           "},{\"name\":\"face\",\"mesh\":0},{\"name\":\"body\",\"mesh\":1}],"
           "\"materials\":[{\"name\":\"mien\",\"pbrMetallicRoughness\":"
           "{\"metallicFactor\":0,\"roughnessFactor\":0.7}}],\"meshes\":" +
           meshes(names) + "," + (states_.empty() ? "" : animation()) +
           "\"accessors\":" + accessors_.text() + ",\"bufferViews\":" + views_.text() +
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

  [[nodiscard]] std::string eye(std::size_t side) const {
    return "\"mesh\":2,\"translation\":" + list_of(eyes_[side]);
  }

  // Only the face has morph targets.
  [[nodiscard]] std::string meshes(const std::string& target_names) const {
    List list;
    for (const Mesh& mesh : meshes_) {
      const bool face = mesh.name == "face";
      list.add("{\"name\":\"" + mesh.name + "\",\"primitives\":[{\"attributes\":{\"POSITION\":" +
               std::to_string(mesh.positions) + ",\"NORMAL\":" + std::to_string(mesh.normals) +
               ",\"COLOR_0\":" + std::to_string(mesh.colors) +
               "},\"indices\":" + std::to_string(mesh.triangles) + ",\"material\":0" +
               (face ? ",\"targets\":" + targets_.text() : "") + "}]" +
               (face ? ",\"weights\":[" + zeros(formats::kControlCount) +
                           "],\"extras\":{\"targetNames\":[" + target_names + "]}"
                     : "") +
               "}");
    }
    return list.text();
  }

  static std::string zeros(std::size_t count) {
    std::string text = "0";
    for (std::size_t i = 1; i < count; ++i) {
      text += ",0";
    }
    return text;
  }

  // Returns the buffer view's index. Its data are aligned to 4 bytes.
  std::size_t add_view(const std::string& data, int target = 0) {
    const std::size_t view =
        views_.add("{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
                   ",\"byteLength\":" + std::to_string(data.size()) +
                   (target == 0 ? "}" : ",\"target\":" + std::to_string(target) + "}"));
    bytes_ += data;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return view;
  }

  std::size_t add_accessor(std::size_t view, const char* type, std::size_t count,
                           const std::string& more = "", int component = kFloat) {
    return accessors_.add("{\"bufferView\":" + std::to_string(view) +
                          ",\"componentType\":" + std::to_string(component) + ",\"type\":\"" +
                          type + "\",\"count\":" + std::to_string(count) + more + "}");
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
        add_view(channel.times()), "SCALAR", channel.keys(),
        ",\"min\":[" + exact(channel.first()) + "],\"max\":[" + exact(channel.last()) + "]");
    const std::size_t output =
        add_accessor(add_view(channel.values()), channel.type(), channel.keys() * components);
    const std::size_t sampler = samplers_.add(
        "{\"input\":" + std::to_string(input) + ",\"output\":" + std::to_string(output) +
        ",\"interpolation\":\"" + (holds_ ? "STEP" : "LINEAR") + "\"}");
    add_moved(sampler, channel.node(), channel.path());
    if (channel.node() == kHead && std::string_view(channel.path()) == "translation") {
      add_moved(sampler, kBody, channel.path());
    }
  }

  void add_moved(std::size_t sampler, int node, const char* path) {
    channels_.add("{\"sampler\":" + std::to_string(sampler) +
                  ",\"target\":{\"node\":" + std::to_string(node) + ",\"path\":\"" + path + "\"}}");
  }

  struct Mesh {
    std::string name;
    std::size_t positions, normals, colors, triangles;  // accessors
  };

  static std::string list_of(const Vector& vector) {
    return "[" + exact(vector[0]) + "," + exact(vector[1]) + "," + exact(vector[2]) + "]";
  }

  // With a leading comma.
  static std::string bounds_of(const std::vector<Vector>& vectors) {
    Vector low = vectors[0], high = vectors[0];
    for (const Vector& vector : vectors) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], vector[k]);
        high[k] = std::max(high[k], vector[k]);
      }
    }
    return ",\"min\":" + list_of(low) + ",\"max\":" + list_of(high);
  }

  static void put_vector(std::string& bytes, const Vector& vector) {
    for (const float value : vector) {
      put_float(bytes, static_cast<double>(value));
    }
  }

  std::size_t add_vectors(const std::vector<Vector>& vectors, bool bounded) {
    std::string data;
    for (const Vector& vector : vectors) {
      put_vector(data, vector);
    }
    return add_accessor(add_view(data, kVertices), "VEC3", vectors.size(),
                        bounded ? bounds_of(vectors) : "");
  }

  void add_mesh(const char* name, const AvatarMesh& mesh) {
    std::string colors, triangles;
    for (const auto& color : mesh.colors) {
      colors.append(color.begin(), color.end());
    }
    for (const std::uint16_t index : mesh.triangles) {
      put_short(triangles, index);
    }
    meshes_.push_back({name, add_vectors(mesh.positions, true), add_vectors(mesh.normals, false),
                       add_accessor(add_view(colors, kVertices), "VEC4", mesh.colors.size(),
                                    ",\"normalized\":true", kUnsignedByte),
                       add_accessor(add_view(triangles, kIndices), "SCALAR", mesh.triangles.size(),
                                    "", kUnsignedShort)});
  }

  // Sparse: most targets move few vertices.
  std::size_t add_target(const std::vector<Vector>& offsets) {
    std::string moved, values;
    std::size_t count = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (offsets[i] != Vector{}) {
        put_short(moved, static_cast<std::uint16_t>(i));
        put_vector(values, offsets[i]);
        ++count;
      }
    }
    std::string sparse;
    if (count > 0) {
      const std::size_t indices = add_view(moved), offset_view = add_view(values);
      sparse = ",\"sparse\":{\"count\":" + std::to_string(count) +
               ",\"indices\":{\"bufferView\":" + std::to_string(indices) +
               ",\"componentType\":" + std::to_string(kUnsignedShort) +
               "},\"values\":{\"bufferView\":" + std::to_string(offset_view) + "}}";
    }
    return accessors_.add("{\"componentType\":" + std::to_string(kFloat) +
                          ",\"type\":\"VEC3\",\"count\":" + std::to_string(offsets.size()) +
                          bounds_of(offsets) + sparse + "}");
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
  List accessors_, views_, samplers_, channels_, targets_;
  std::vector<Mesh> meshes_;
  std::array<Vector, 2> eyes_{};
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
