#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>

#include "formats/animation/base64.h"
#include "formats/animation/csv_cells.h"
#include "formats/animation/gltf.h"
#include "formats/animation/json.h"
#include "formats/animation/numbers.h"
#include "formats/animation/rotation.h"

namespace mien::formats {
namespace {

using Kind = JsonValue::Kind;

std::uint32_t u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

bool fail_at_byte(std::size_t byte, const char* what, Fault& fault) {
  return fail(fault, 0, byte, what);
}

// What a file is made of.
struct Parts {
  std::string_view json;
  std::optional<std::string_view> data;
};

bool split_glb(std::string_view bytes, Parts& parts, Fault& fault) {
  constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;
  if (bytes.size() < 20) {
    return fail_at_byte(bytes.size(), "the file ends within its header", fault);
  }
  if (u32(bytes, 4) != 2) {
    return fail_at_byte(4, "is not version 2 of glTF", fault);
  }
  if (u32(bytes, 8) != bytes.size()) {
    return fail_at_byte(8, "says that the file has another length", fault);
  }
  if (u32(bytes, 16) != kJson) {
    return fail_at_byte(16, "the first chunk is not JSON", fault);
  }
  const std::size_t json_bytes = u32(bytes, 12);
  if (json_bytes > bytes.size() - 20) {
    return fail_at_byte(12, "the chunk does not fit into the file", fault);
  }
  parts.json = bytes.substr(20, json_bytes);
  const std::size_t next = 20 + json_bytes;
  if (bytes.size() - next < 8 || u32(bytes, next + 4) != kBin) {
    return true;
  }
  if (u32(bytes, next) > bytes.size() - next - 8) {
    return fail_at_byte(next, "the chunk does not fit into the file", fault);
  }
  parts.data = bytes.substr(next + 8, u32(bytes, next));
  return true;
}

// ARKit's mouthSmileLeft, or its mouthSmile_L.
std::size_t control_of(std::string_view name) {
  std::string whole(name);
  if (name.ends_with("_L") || name.ends_with("_R")) {
    whole.resize(whole.size() - 2);
    whole += name.ends_with("_L") ? "Left" : "Right";
  }
  return index_of(whole, kArkitNames);
}

// Keys of one channel: `width` numbers at each time.
struct Track {
  std::vector<float> times;
  std::vector<float> values;
  std::size_t width = 0;

  [[nodiscard]] const float* key(std::size_t i) const { return values.data() + i * width; }
};

class Reader {
 public:
  Reader(const Parts& parts, Fault& fault) : parts_(parts), fault_(fault) {}

  bool read(Clip& clip) {
    if (!parse_json(parts_.json, root_, fault_) || !read_buffers()) {
      return false;
    }
    const JsonValue* animations = list(root_, "animations");
    if (animations == nullptr || animations->items.empty()) {
      return root_.fail_here("there is no animation", fault_);
    }
    const JsonValue& animation = animations->items.front();
    return read_channels(animation) && read_extras(animation) && make_frames(animation, clip);
  }

 private:
  static const JsonValue* list(const JsonValue& object, std::string_view key) {
    const JsonValue* found = object.find(key);
    return found != nullptr && found->is(Kind::kArray) ? found : nullptr;
  }

  // The item of a list of the document that a number of `from` says.
  bool item(const JsonValue& from, std::string_view key, std::string_view of,
            const JsonValue*& found) {
    const JsonValue* index = from.find(key);
    const JsonValue* items = list(root_, of);
    std::int64_t i = -1;
    if (index == nullptr || !index->integer(i)) {
      return from.fail_here(std::string(key) + ": has to be here", fault_);
    }
    if (items == nullptr || i < 0 || static_cast<std::uint64_t>(i) >= items->items.size()) {
      return index->fail_here(std::string(key) + ": there is no such one", fault_);
    }
    found = &items->items[static_cast<std::size_t>(i)];
    return true;
  }

  // 0 where there is none; false where it is no number of bytes or elements.
  bool count(const JsonValue& from, std::string_view key, std::size_t& value) {
    value = 0;
    const JsonValue* found = from.find(key);
    std::int64_t read = 0;
    constexpr std::int64_t kMost = 0xFFFFFFFF;
    if (found == nullptr) {
      return true;
    }
    if (!found->integer(read) || read < 0 || read > kMost) {
      return found->fail_here(std::string(key) + ": is out of range", fault_);
    }
    value = static_cast<std::size_t>(read);
    return true;
  }

  bool read_buffers() {
    const JsonValue* buffers = list(root_, "buffers");
    for (std::size_t i = 0; buffers != nullptr && i < buffers->items.size(); ++i) {
      const JsonValue& buffer = buffers->items[i];
      const JsonValue* uri = buffer.find("uri");
      if (uri == nullptr) {
        if (i != 0 || !parts_.data) {
          return buffer.fail_here("the buffer has no data in this file", fault_);
        }
        buffers_.emplace_back(*parts_.data);
        continue;
      }
      constexpr std::string_view kBase64 = ";base64,";
      const std::size_t comma = uri->text.find(kBase64);
      std::string bytes;
      if (!uri->text.starts_with("data:") || comma == std::string::npos) {
        return uri->fail_here("uri: data in another file is not read", fault_);
      }
      if (!parse_base64(std::string_view(uri->text).substr(comma + kBase64.size()), bytes)) {
        return uri->fail_here("uri: is not base64", fault_);
      }
      buffers_.push_back(std::move(bytes));
    }
    return true;
  }

  // `width` floats an element.
  bool floats(const JsonValue& accessor, std::size_t width, std::vector<float>& values) {
    const JsonValue* view = nullptr;
    const JsonValue* buffer = nullptr;
    std::size_t elements = 0, offset = 0, view_offset = 0, view_bytes = 0, stride = 0, type = 0;
    if (accessor.find("sparse") != nullptr) {
      return accessor.fail_here("sparse accessors are not read", fault_);
    }
    if (!item(accessor, "bufferView", "bufferViews", view) ||
        !item(*view, "buffer", "buffers", buffer) || !count(accessor, "count", elements) ||
        !count(accessor, "byteOffset", offset) || !count(accessor, "componentType", type) ||
        !count(*view, "byteOffset", view_offset) || !count(*view, "byteLength", view_bytes) ||
        !count(*view, "byteStride", stride)) {
      return false;
    }
    constexpr std::size_t kFloat = 5126;
    if (type != kFloat) {
      return accessor.fail_here("componentType: only 5126 (float) is read", fault_);
    }
    const std::string& bytes =
        buffers_[static_cast<std::size_t>(buffer - root_.find("buffers")->items.data())];
    const std::size_t element_bytes = 4 * width;
    stride = stride == 0 ? element_bytes : stride;
    const std::uint64_t needed =
        elements == 0 ? 0 : std::uint64_t{elements - 1} * stride + element_bytes;
    if (stride < element_bytes || std::uint64_t{view_offset} + view_bytes > bytes.size() ||
        offset + needed > view_bytes) {
      return accessor.fail_here("the data of the accessor does not fit into its buffer", fault_);
    }
    values.resize(elements * width);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t at = view_offset + offset + i / width * stride + 4 * (i % width);
      values[i] = std::bit_cast<float>(u32(bytes, at));
      if (!std::isfinite(values[i])) {
        return accessor.fail_here("a value is not a finite number", fault_);
      }
    }
    return true;
  }

  // Keys of a sampler; of cubic splines their values, without tangents.
  bool read_sampler(const JsonValue& sampler, std::size_t width, std::size_t parts, Track& track) {
    const JsonValue* input = nullptr;
    const JsonValue* output = nullptr;
    if (!item(sampler, "input", "accessors", input) ||
        !item(sampler, "output", "accessors", output) || !floats(*input, 1, track.times)) {
      return false;
    }
    std::vector<float> values;
    if (!floats(*output, width, values)) {
      return false;
    }
    track.width = width * parts;
    const JsonValue* way = sampler.find("interpolation");
    const bool cubic = way != nullptr && way->text == "CUBICSPLINE";
    const std::size_t keys = track.times.size();
    const std::size_t in_key = track.width * (cubic ? 3 : 1);
    if (keys == 0 || values.size() != keys * in_key) {
      return output->fail_here("the values are not as many as the times ask for", fault_);
    }
    for (std::size_t i = 0; i < keys; ++i) {
      const auto begin =
          values.begin() + static_cast<std::ptrdiff_t>(i * in_key + (cubic ? track.width : 0));
      track.values.insert(track.values.end(), begin,
                          begin + static_cast<std::ptrdiff_t>(track.width));
    }
    const bool ascending = std::adjacent_find(track.times.begin(), track.times.end(),
                                              std::greater_equal<>()) == track.times.end();
    std::int64_t first_ns = 0, last_ns = 0;
    if (!ascending || !time_of(decimal(track.times.front()), kSecond_ns, first_ns) ||
        !time_of(decimal(track.times.back()), kSecond_ns, last_ns)) {
      return input->fail_here("times have to ascend, and to be times", fault_);
    }
    return true;
  }

  bool read_channels(const JsonValue& animation) {
    const JsonValue* channels = list(animation, "channels");
    const JsonValue* samplers = list(animation, "samplers");
    if (channels == nullptr || samplers == nullptr) {
      return animation.fail_here("the animation has no channels or samplers", fault_);
    }
    for (const JsonValue& channel : channels->items) {
      const JsonValue* target = channel.find("target");
      const JsonValue* index = channel.find("sampler");
      std::int64_t i = -1;
      if (index == nullptr || !index->integer(i) || i < 0 ||
          static_cast<std::uint64_t>(i) >= samplers->items.size() || target == nullptr) {
        return channel.fail_here("the channel has no sampler or target", fault_);
      }
      if (target->find("node") != nullptr &&
          !read_channel(*target, samplers->items[static_cast<std::size_t>(i)])) {
        return false;
      }
    }
    return weights_.width > 0 || head_turns_.width > 0 || head_moves_.width > 0 ||
           animation.fail_here("neither weights of a face nor a head are animated", fault_);
  }

  bool read_channel(const JsonValue& target, const JsonValue& sampler) {
    const JsonValue* node = nullptr;
    const JsonValue* path = target.find("path");
    if (!item(target, "node", "nodes", node)) {
      return false;
    }
    const JsonValue* name = node->find("name");
    const std::string_view called = name != nullptr ? name->text : std::string_view();
    const std::string_view what = path != nullptr ? path->text : std::string_view();
    if (what == "weights" && weights_.width == 0) {
      return read_weights(*node, sampler);
    }
    if (what == "rotation" || what == "translation") {
      Track* track = what == "translation"           ? (is_head(called) ? &head_moves_ : nullptr)
                     : is_head(called)               ? &head_turns_
                     : same_name(called, "leftEye")  ? &eye_turns_[0]
                     : same_name(called, "rightEye") ? &eye_turns_[1]
                                                     : nullptr;
      if (track != nullptr && track->width == 0) {
        return read_sampler(sampler, what == "rotation" ? 4 : 3, 1, *track);
      }
    }
    return true;
  }

  static bool is_head(std::string_view name) {
    return name.size() >= 4 && same_name(name.substr(name.size() - 4), "head");
  }

  bool read_weights(const JsonValue& node, const JsonValue& sampler) {
    const JsonValue* mesh = nullptr;
    if (!item(node, "mesh", "meshes", mesh)) {
      return false;
    }
    const JsonValue* extras = mesh->find("extras");
    const JsonValue* names = extras != nullptr ? list(*extras, "targetNames") : nullptr;
    if (names == nullptr || names->items.empty()) {
      return mesh->fail_here("the mesh has no extras.targetNames", fault_);
    }
    bool any = false;
    std::vector<std::size_t> targets;
    for (const JsonValue& target : names->items) {
      targets.push_back(control_of(target.text));
      any = any || targets.back() < kControlCount;
    }
    if (!any) {
      return true;  // some other mesh
    }
    targets_ = std::move(targets);
    return read_sampler(sampler, 1, targets_.size(), weights_);
  }

  bool read_extras(const JsonValue& animation) {
    const JsonValue* extras = animation.find("extras");
    const JsonValue* ours = extras != nullptr ? extras->find("mien") : nullptr;
    if (ours == nullptr) {
      return true;
    }
    ours_ = true;
    const JsonValue* start = ours->find("start_ns");
    if (start != nullptr && !start->integer(start_ns_)) {
      return start->fail_here("start_ns: is not a whole number", fault_);
    }
    if (start != nullptr && !time_allowed(start_ns_)) {
      return start->fail_here("start_ns: is out of range", fault_);
    }
    const JsonValue* states = ours->find("states");
    states_ = states != nullptr ? states->text : "";
    const JsonValue* names = list(*ours, "not_driven");
    for (std::size_t i = 0; names != nullptr && i < names->items.size(); ++i) {
      const std::size_t which = index_of(names->items[i].text, kArkitNames);
      if (which < kControlCount) {
        not_driven_[which] = true;
      }
    }
    return true;
  }

  bool make_frames(const JsonValue& animation, Clip& clip) {
    const std::vector<float>& times = weights_.width > 0      ? weights_.times
                                      : head_turns_.width > 0 ? head_turns_.times
                                                              : head_moves_.times;
    for (std::size_t i = 0; i < times.size(); ++i) {
      Frame frame;
      frame.number = static_cast<std::int64_t>(i);
      std::int64_t since_ns = 0;
      const bool is_time = time_of(decimal(times[i]), kSecond_ns, since_ns);
      frame.time_ns = start_ns_ + since_ns;  // both are allowed, and so it fits
      if (!is_time || !time_allowed(frame.time_ns)) {
        return animation.fail_here("the times of frames are out of range", fault_);
      }
      set_controls(i, frame, clip.out_of_range);
      frame.head = turn_at(head_turns_, times[i]);
      frame.position_m = place_at(head_moves_, times[i]);
      const auto left = turn_at(eye_turns_[0], times[i]);
      const auto right = turn_at(eye_turns_[1], times[i]);
      if (left && right) {
        frame.eyes = {*left, *right};
      }
      set_state(i, frame);
      clip.frames.push_back(std::move(frame));
    }
    return true;
  }

  void set_controls(std::size_t key, Frame& frame, std::int64_t& out_of_range) const {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      if (targets_[i] < kControlCount && !not_driven_[targets_[i]]) {
        frame.controls[targets_[i]] = into_range(decimal(weights_.key(key)[i]), out_of_range);
      }
    }
  }

  void set_state(std::size_t key, Frame& frame) const {
    if (key < states_.size()) {
      frame.state = states_[key] == 's'   ? FaceState::kSearching
                    : states_[key] == 'l' ? FaceState::kLost
                                          : FaceState::kTracking;
    }
  }

  // Between which keys a time lies. In files of this program what has no key is not there.
  [[nodiscard]] bool find_keys(const Track& track, float time, std::size_t& before,
                               std::size_t& after, double& share) const {
    if (track.width == 0) {
      return false;
    }
    const auto next = std::lower_bound(track.times.begin(), track.times.end(), time);
    after = static_cast<std::size_t>(next - track.times.begin());
    const bool exact = next != track.times.end() && *next == time;
    if (exact || after == 0 || after == track.times.size()) {
      after = std::min(after, track.times.size() - 1);
      before = after;
      share = 0.0;
      return exact || !ours_;
    }
    before = after - 1;
    share = static_cast<double>(time - track.times[before]) /
            static_cast<double>(track.times[after] - track.times[before]);
    return !ours_;
  }

  [[nodiscard]] std::optional<Angles> turn_at(const Track& track, float time) const {
    std::size_t before = 0, after = 0;
    double share = 0.0;
    if (!find_keys(track, time, before, after, share)) {
      return std::nullopt;
    }
    const auto at = [&track](std::size_t i) {
      const float* q = track.key(i);
      const Quaternion turn = {decimal(q[0]), decimal(q[1]), decimal(q[2]), decimal(q[3])};
      const bool none = turn[0] == 0.0 && turn[1] == 0.0 && turn[2] == 0.0 && turn[3] == 0.0;
      return none ? Angles() : angles(turn);
    };
    return between(at(before), at(after), share);
  }

  [[nodiscard]] std::optional<std::array<double, 3>> place_at(const Track& track,
                                                              float time) const {
    std::size_t before = 0, after = 0;
    double share = 0.0;
    if (!find_keys(track, time, before, after, share)) {
      return std::nullopt;
    }
    std::array<double, 3> place;
    for (std::size_t i = 0; i < 3; ++i) {
      const double from = decimal(track.key(before)[i]);
      place[i] = from + share * (decimal(track.key(after)[i]) - from);
    }
    return place;
  }

  Parts parts_;
  Fault& fault_;
  JsonValue root_;
  std::vector<std::string> buffers_;
  std::vector<std::size_t> targets_;  // control of each morph target; kControlCount: another
  Track weights_, head_turns_, head_moves_;
  std::array<Track, 2> eye_turns_;
  bool ours_ = false;
  std::int64_t start_ns_ = 0;
  std::string states_;
  std::array<bool, kControlCount> not_driven_{};
};

}  // namespace

bool read_gltf(std::string_view bytes, const ReadOptions& /*options*/, Clip& clip, Fault& fault) {
  Parts parts{bytes, std::nullopt};
  if (bytes.starts_with("glTF") && !split_glb(bytes, parts, fault)) {
    return false;
  }
  Clip read;
  if (!Reader(parts, fault).read(read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::formats
