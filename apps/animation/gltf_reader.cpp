// Reads animations from glTF files.
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/animation/csv_cells.h"
#include "apps/animation/gltf.h"
#include "apps/animation/gltf_file.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

// ARKit's mouthSmileLeft, or its mouthSmile_L.
std::size_t control_of(std::string_view name) {
  std::string whole(name);
  if (name.ends_with("_L") || name.ends_with("_R")) {
    whole.resize(whole.size() - 2);
    whole += name.ends_with("_L") ? "Left" : "Right";
  }
  return formats::index_of(whole, formats::kArkitNames);
}

// The keys of a channel: `width` numbers at each time.
struct Track {
  GltfNumbers times;
  GltfNumbers values;
  std::size_t width = 0;  // 0: no such channel
  bool cubic = false;     // each value is between its two tangents
  bool step = false;      // each value is held until the next

  [[nodiscard]] std::size_t in_key() const { return width * (cubic ? 3 : 1); }
  [[nodiscard]] double value(std::size_t key, std::size_t i) const {
    return decimal(values[key * in_key() + (cubic ? width : 0) + i]);
  }
};

// The first key at or after `time`.
std::size_t lower_bound(const GltfNumbers& times, float time) {
  std::size_t begin = 0, end = times.size();
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (times[middle] < time) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

std::optional<JsonValue> list(const JsonValue& object, std::string_view key) {
  const std::optional<JsonValue> found = object.find(key);
  return found && found->is(JsonValue::Kind::kArray) ? found : std::nullopt;
}

class GltfReader {
 public:
  GltfReader(const ReadOptions& options, Fault& fault) : file_(options, fault), fault_(fault) {}

  bool read(std::string_view bytes, Clip& clip) {
    if (!file_.read(bytes)) {
      return false;
    }
    const std::optional<JsonValue> animations = list(file_.root(), "animations");
    if (!animations || animations->empty()) {
      return file_.root().fail_here("no animation", fault_);
    }
    const JsonValue animation = *animations->items().begin();
    return read_channels(animation) && read_extras(animation) && make_frames(animation, clip);
  }

 private:
  // Reads the keys of a sampler; of cubic splines the values without tangents.
  bool read_sampler(const JsonValue& sampler, std::size_t width, std::size_t parts, Track& track) {
    const std::optional<std::size_t> input = file_.index(sampler, "input", "accessors");
    const std::optional<std::size_t> output =
        input ? file_.index(sampler, "output", "accessors") : std::nullopt;
    if (!output || !file_.numbers(file_.item("accessors", *input), 1, track.times) ||
        !file_.numbers(file_.item("accessors", *output), width, track.values)) {
      return false;
    }
    track.width = width * parts;
    const std::optional<JsonValue> way = sampler.find("interpolation");
    track.cubic = way && way->text() == "CUBICSPLINE";
    track.step = way && way->text() == "STEP";
    const std::size_t keys = track.times.size();
    if (keys == 0 || track.values.size() != keys * track.in_key()) {
      return file_.item("accessors", *output)
          .fail_here("output: the number of values does not match the number of times", fault_);
    }
    bool ascending = true;
    for (std::size_t i = 1; i < keys; ++i) {
      ascending = ascending && track.times[i - 1] < track.times[i];
    }
    std::int64_t first_ns = 0, last_ns = 0;
    if (!ascending || !time_of(decimal(track.times[0]), kSecond_ns, first_ns) ||
        !time_of(decimal(track.times[keys - 1]), kSecond_ns, last_ns)) {
      return file_.item("accessors", *input)
          .fail_here("times must increase and be in range", fault_);
    }
    return true;
  }

  bool read_channels(const JsonValue& animation) {
    const std::optional<JsonValue> channels = list(animation, "channels");
    const std::optional<JsonValue> listed = list(animation, "samplers");
    if (!channels || !listed) {
      return animation.fail_here("animations: no channels or samplers", fault_);
    }
    std::vector<JsonValue> samplers;
    for (const JsonValue sampler : listed->items()) {
      samplers.push_back(sampler);
    }
    for (const JsonValue channel : channels->items()) {
      const std::optional<JsonValue> target = channel.find("target");
      const std::optional<JsonValue> index = channel.find("sampler");
      std::int64_t i = -1;
      if (!index || !index->integer(i) || i < 0 ||
          static_cast<std::uint64_t>(i) >= samplers.size() || !target) {
        return channel.fail_here("channels: no sampler or target", fault_);
      }
      if (target->find("node") && !read_channel(*target, samplers[static_cast<std::size_t>(i)])) {
        return false;
      }
    }
    return weights_.width > 0 || head_turns_.width > 0 || head_moves_.width > 0 ||
           animation.fail_here("neither face weights nor a head are animated", fault_);
  }

  bool read_channel(const JsonValue& target, const JsonValue& sampler) {
    const std::optional<std::size_t> index = file_.index(target, "node", "nodes");
    if (!index) {
      return false;
    }
    const JsonValue& node = file_.item("nodes", *index);
    const std::optional<JsonValue> name = node.find("name"), path = target.find("path");
    const std::string called = name ? name->text() : "", what = path ? path->text() : "";
    if (what == "weights" && weights_.width == 0) {
      return read_weights(node, sampler);
    }
    if (what == "rotation" || what == "translation") {
      Track* track = what == "translation" ? (is_head(called) ? &head_moves_ : nullptr)
                     : is_head(called)     ? &head_turns_
                     : formats::same_name(called, "leftEye")  ? &eye_turns_[0]
                     : formats::same_name(called, "rightEye") ? &eye_turns_[1]
                                                              : nullptr;
      if (track != nullptr && track->width == 0) {
        return read_sampler(sampler, what == "rotation" ? 4 : 3, 1, *track);
      }
    }
    return true;
  }

  static bool is_head(std::string_view name) {
    return name.size() >= 4 && formats::same_name(name.substr(name.size() - 4), "head");
  }

  bool read_weights(const JsonValue& node, const JsonValue& sampler) {
    const std::optional<std::size_t> index = file_.index(node, "mesh", "meshes");
    if (!index) {
      return false;
    }
    // Checks each mesh once, however many channels animate it.
    if (other_meshes_.size() <= *index) {
      other_meshes_.resize(*index + 1);
    }
    if (other_meshes_[*index]) {
      return true;
    }
    const JsonValue& mesh = file_.item("meshes", *index);
    const std::optional<JsonValue> extras = mesh.find("extras");
    const std::optional<JsonValue> names = extras ? list(*extras, "targetNames") : std::nullopt;
    if (!names || names->empty()) {
      return mesh.fail_here("extras.targetNames: missing", fault_);
    }
    bool any = false;
    std::vector<std::size_t> targets;
    for (const JsonValue target : names->items()) {
      targets.push_back(control_of(target.text()));
      any = any || targets.back() < formats::kControlCount;
    }
    if (!any) {
      other_meshes_[*index] = true;
      return true;
    }
    targets_ = std::move(targets);
    return read_sampler(sampler, 1, targets_.size(), weights_);
  }

  bool read_extras(const JsonValue& animation) {
    const std::optional<JsonValue> extras = animation.find("extras");
    const std::optional<JsonValue> ours = extras ? extras->find("mien") : std::nullopt;
    if (!ours) {
      return true;
    }
    ours_ = true;
    const std::optional<JsonValue> start = ours->find("start_ns");
    if (start && !start->integer(start_ns_)) {
      return start->fail_here("start_ns: expected an integer", fault_);
    }
    if (start && !time_allowed(start_ns_)) {
      return start->fail_here("start_ns: out of range", fault_);
    }
    const std::optional<JsonValue> states = ours->find("states");
    states_ = states ? states->text() : "";
    const std::optional<JsonValue> names = list(*ours, "not_driven");
    if (!names) {
      return true;
    }
    for (const JsonValue item : names->items()) {
      const std::size_t which = formats::index_of(item.text(), formats::kArkitNames);
      if (which < formats::kControlCount) {
        not_driven_[which] = true;
      }
    }
    return true;
  }

  bool make_frames(const JsonValue& animation, Clip& clip) {
    const GltfNumbers& times = weights_.width > 0      ? weights_.times
                               : head_turns_.width > 0 ? head_turns_.times
                                                       : head_moves_.times;
    for (std::size_t i = 0; i < times.size(); ++i) {
      Frame frame;
      frame.number = static_cast<std::int64_t>(i);
      std::int64_t since_ns = 0;
      const bool is_time = time_of(decimal(times[i]), kSecond_ns, since_ns);
      frame.time_ns =
          start_ns_ + since_ns;  // both are within the limits, so the sum does not overflow
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
      frame.step = weights_.step;
      set_state(i, frame);
      if (!add_frame(clip, frame, 0, fault_)) {
        return false;
      }
    }
    return true;
  }

  void set_controls(std::size_t key, Frame& frame, std::int64_t& out_of_range) const {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      if (targets_[i] < formats::kControlCount && !not_driven_[targets_[i]]) {
        frame.controls[targets_[i]] = into_range(weights_.value(key, i), out_of_range);
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

  // Finds the keys around a time. In files of this program, data without a key are absent.
  [[nodiscard]] bool find_keys(const Track& track, float time, std::size_t& before,
                               std::size_t& after, double& fraction) const {
    if (track.width == 0) {
      return false;
    }
    const std::size_t keys = track.times.size();
    after = lower_bound(track.times, time);
    const bool exact = after < keys && track.times[after] == time;
    if (exact || after == 0 || after == keys) {
      after = std::min(after, keys - 1);
      before = after;
      fraction = 0.0;
      return exact || !ours_;
    }
    before = after - 1;
    fraction = track.step ? 0.0
                          : static_cast<double>(time - track.times[before]) /
                                static_cast<double>(track.times[after] - track.times[before]);
    return !ours_;
  }

  [[nodiscard]] std::optional<Angles> turn_at(const Track& track, float time) const {
    std::size_t before = 0, after = 0;
    double fraction = 0.0;
    if (!find_keys(track, time, before, after, fraction)) {
      return std::nullopt;
    }
    const auto at = [&track](std::size_t i) {
      const Quaternion turn = {track.value(i, 0), track.value(i, 1), track.value(i, 2),
                               track.value(i, 3)};
      const bool none = turn[0] == 0.0 && turn[1] == 0.0 && turn[2] == 0.0 && turn[3] == 0.0;
      return none ? Angles() : angles(turn);
    };
    return between(at(before), at(after), fraction);
  }

  [[nodiscard]] std::optional<std::array<double, 3>> place_at(const Track& track,
                                                              float time) const {
    std::size_t before = 0, after = 0;
    double fraction = 0.0;
    if (!find_keys(track, time, before, after, fraction)) {
      return std::nullopt;
    }
    std::array<double, 3> place;
    for (std::size_t i = 0; i < 3; ++i) {
      const double from = track.value(before, i);
      place[i] = from + fraction * (track.value(after, i) - from);
    }
    return place;
  }

  GltfFile file_;
  Fault& fault_;
  std::vector<std::size_t> targets_;  // control of each morph target; kControlCount: none
  std::vector<bool> other_meshes_;    // those without face targets
  Track weights_, head_turns_, head_moves_;
  std::array<Track, 2> eye_turns_;
  bool ours_ = false;
  std::int64_t start_ns_ = 0;
  std::string states_;
  std::array<bool, formats::kControlCount> not_driven_{};
};

}  // namespace

bool read_gltf(std::string_view bytes, const ReadOptions& options, Clip& clip, Fault& fault) {
  Clip read;
  read.frames.limit_bytes(max_clip_bytes(bytes.size()));
  if (!GltfReader(options, fault).read(bytes, read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::animation
