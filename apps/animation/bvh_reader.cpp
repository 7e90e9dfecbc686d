// Reads BVH.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "apps/animation/bvh.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"

namespace mien::animation {
namespace {

constexpr double kDegreesInRadian = 180.0 / std::numbers::pi;
constexpr std::int64_t kMaxFrames = 10'000'000;
// Largest factor between the size of a skeleton and the typical size.
constexpr double kTolerance = 3.2;

using Vec3 = std::array<double, 3>;

// The words of a text with their positions.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  // Empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) {
      if (text_[at_] == '\n') {
        ++line_;
        line_begin_ = at_ + 1;
      }
      ++at_;
    }
    const std::size_t begin = at_;
    word_line_ = line_;
    word_column_ = begin - line_begin_ + 1;
    while (at_ < text_.size() && !is_blank(text_[at_])) {
      ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }

  [[nodiscard]] std::size_t line() const { return word_line_; }

  // Reports an error at the last word.
  bool fail_here(std::string what, Fault& fault) const {
    return fail(fault, word_line_, word_column_, std::move(what));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1, line_begin_ = 0, word_line_ = 1, word_column_ = 1;
};

struct Channel {
  std::size_t joint;
  std::size_t axis;
  bool rotates;
};

struct Joint {
  std::size_t parent;  // the root refers to itself
  std::string name;
  Vec3 offset;
  Vec3 end;                         // of its last end site
  std::optional<std::size_t> link;  // index in the chain from head to root
};

// The pose of a joint in a frame.
struct Pose {
  Quaternion turn = {0.0, 0.0, 0.0, 1.0};
  Vec3 move{};
  Vec3 degrees{};
};

double norm(const Vec3& v) { return std::hypot(v[0], v[1], v[2]); }

Vec3 rotated(const Quaternion& q, const Vec3& v) {
  const Vec3 u = {q[0], q[1], q[2]};
  const auto cross = [](const Vec3& a, const Vec3& b) -> Vec3 {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vec3 once = cross(u, v);
  const Vec3 twice = cross(u, once);
  Vec3 turned;
  for (std::size_t i = 0; i < 3; ++i) {
    turned[i] = v[i] + 2.0 * (q[3] * once[i] + twice[i]);
  }
  return turned;
}

class BvhReader {
 public:
  BvhReader(std::string_view text, const ReadOptions& options, Fault& fault)
      : words_(text), options_(options), fault_(fault) {}

  bool read(Clip& clip) {
    if (!expect("HIERARCHY") || !expect("ROOT") || !read_joint(0, 0)) {
      return false;
    }
    find_head();
    find_unit(clip);
    return read_motion(clip);
  }

 private:
  bool expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    return formats::same_name(word, wanted) ||
           words_.fail_here("expected " + quoted(wanted) + " (got " + quoted(word) + ")", fault_);
  }

  bool number(double& value) {
    const std::string_view word = words_.next();
    return parse_number(word, value) || words_.fail_here(quoted(word) + " is not a number", fault_);
  }

  bool vector(Vec3& value) { return number(value[0]) && number(value[1]) && number(value[2]); }

  // Reads a joint from its name to its '}'.
  bool read_joint(std::size_t parent, int depth) {
    constexpr int kMaxDepth = 100;
    if (depth > kMaxDepth) {
      return words_.fail_here("too deeply nested", fault_);
    }
    const std::size_t self = joints_.size();
    joints_.push_back({parent, std::string(words_.next()), {}, {}, {}});
    Vec3 offset{};
    if (!expect("{") || !expect("OFFSET") || !vector(offset) || !expect("CHANNELS") ||
        !read_channels(self)) {
      return false;
    }
    joints_[self].offset = offset;
    for (std::string_view word = words_.next(); word != "}"; word = words_.next()) {
      if (formats::same_name(word, "JOINT")) {
        if (!read_joint(self, depth + 1)) {
          return false;
        }
      } else if (formats::same_name(word, "End")) {
        if (!expect("Site") || !expect("{") || !expect("OFFSET") || !vector(joints_[self].end) ||
            !expect("}")) {
          return false;
        }
      } else {
        return words_.fail_here("expected JOINT, End or '}' (got " + quoted(word) + ")", fault_);
      }
    }
    return true;
  }

  bool read_channels(std::size_t joint) {
    std::int64_t count = 0;
    const std::string_view word = words_.next();
    if (!parse_number(word, count) || count < 0 || count > 6) {
      return words_.fail_here(
          "CHANNELS: invalid number of channels (got " + quoted(word) + ", expected 0 to 6)",
          fault_);
    }
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string_view name = words_.next();
      const bool rotates = name.size() == 9 && formats::same_name(name.substr(1), "rotation");
      const bool moves = name.size() == 9 && formats::same_name(name.substr(1), "position");
      const std::size_t axis =
          name.empty() ? 3 : std::string_view("xyz").find(formats::to_lower(name[0]));
      if ((!rotates && !moves) || axis > 2) {
        return words_.fail_here("CHANNELS: unknown channel " + quoted(name), fault_);
      }
      channels_.push_back({joint, axis, rotates});
    }
    return true;
  }

  void find_head() {
    const auto found = std::find_if(joints_.begin(), joints_.end(), [](const Joint& joint) {
      const std::string_view name = joint.name;
      return name.size() >= 4 && formats::same_name(name.substr(name.size() - 4), "head");
    });
    head_ = found != joints_.end() ? static_cast<std::size_t>(found - joints_.begin()) : 0;
    for (std::size_t i = head_; i != joints_[i].parent; i = joints_[i].parent) {
      chain_.push_back(i);
    }
    chain_.push_back(0);
    for (std::size_t link = 0; link < chain_.size(); ++link) {
      joints_[chain_[link]].link = link;
    }
    std::string order;
    for (const Channel& channel : channels_) {
      if (channel.rotates && channel.joint == head_) {
        order += "xyz"[channel.axis];
      }
    }
    own_order_ = head_ == 0 && order == "yxz";
  }

  void find_unit(Clip& clip) {
    const std::optional<LengthUnit> detected = detected_unit();
    const LengthUnit unit = options_.bvh_unit.value_or(detected.value_or(LengthUnit::kMetres));
    metres_ = metres(unit);
    if (!options_.bvh_unit) {
      clip.notes.push_back(std::string("positions: ") + name(unit) + ", " +
                           (detected ? "detected from the size of the skeleton" : "default") +
                           " (--from-bvh-unit)");
    }
  }

  // Inches are never detected: a skeleton in inches may be a small one in centimetres.
  [[nodiscard]] std::optional<LengthUnit> detected_unit() const {
    double length = 0.0;
    for (const std::size_t joint : chain_) {
      length += joint != 0 ? norm(joints_[joint].offset) : 0.0;
    }
    // Adults have 0.6 m from hips to head, and a head of 0.1 to 0.25 m. The tolerance is half of
    // the distance to the next unit in both directions.
    const double typical_m = length > 0.0 ? 0.6 : 0.15;
    length = length > 0.0 ? length : norm(joints_[head_].end);
    for (const LengthUnit unit :
         {LengthUnit::kMetres, LengthUnit::kCentimetres, LengthUnit::kMillimetres}) {
      const double ratio = length * metres(unit) / typical_m;
      if (ratio > 1.0 / kTolerance && ratio < kTolerance) {
        return unit;
      }
    }
    return std::nullopt;
  }

  bool read_motion(Clip& clip) {
    if (channels_.empty()) {
      return words_.fail_here("no joint has a channel", fault_);
    }
    if (!expect("MOTION") || !expect("Frames:")) {
      return false;
    }
    std::int64_t count = 0;
    const std::string_view word = words_.next();
    if (!parse_number(word, count) || count < 1 || count > kMaxFrames) {
      return words_.fail_here("Frames: invalid number of frames (got " + quoted(word) +
                                  ", expected 1 to " + std::to_string(kMaxFrames) + ")",
                              fault_);
    }
    double step_s = 0.0;
    if (!expect("Frame") || !expect("Time:") || !number(step_s)) {
      return false;
    }
    if (step_s <= 0.0 || step_s > 3600.0) {
      return words_.fail_here("frame time out of range", fault_);
    }
    for (std::int64_t i = 0; i < count; ++i) {
      Frame frame;
      frame.number = i;
      if (!time_of(static_cast<double>(i) * step_s, kSecond_ns, frame.time_ns)) {
        return words_.fail_here("duration out of range", fault_);
      }
      if (!read_pose(frame) || !add_frame(clip, frame, words_.line(), fault_)) {
        return false;
      }
    }
    return words_.next().empty() ||
           words_.fail_here("more than " + std::to_string(count) + " frames", fault_);
  }

  // Reads only the joints between root and head, so that time depends on the number of values, not
  // of joints.
  bool read_pose(Frame& frame) {
    std::vector<Pose> poses(chain_.size());
    bool moved = false;
    for (const Channel& channel : channels_) {
      double value = 0.0;
      if (!number(value)) {
        return false;
      }
      moved = moved || !channel.rotates;
      if (joints_[channel.joint].link) {
        turn_or_move(channel, value, poses[*joints_[channel.joint].link]);
      }
    }
    Quaternion turn = {0.0, 0.0, 0.0, 1.0};
    Vec3 place{};
    for (std::size_t link = 0; link < chain_.size(); ++link) {
      const Vec3 turned = rotated(poses[link].turn, place);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = joints_[chain_[link]].offset[axis] + poses[link].move[axis] + turned[axis];
      }
      turn = product(poses[link].turn, turn);
    }
    // A root with our rotation order has the exact angles.
    const Vec3& own = poses.front().degrees;
    frame.head = own_order_ ? Angles{own[0] / kDegreesInRadian, own[1] / kDegreesInRadian,
                                     own[2] / kDegreesInRadian}
                            : angles(turn);
    if (moved) {
      frame.position_m = {place[0] * metres_, place[1] * metres_, place[2] * metres_};
    }
    return true;
  }

  static void turn_or_move(const Channel& channel, double value, Pose& pose) {
    if (!channel.rotates) {
      pose.move[channel.axis] = value;
      return;
    }
    Quaternion turn = {0.0, 0.0, 0.0, std::cos(value / kDegreesInRadian / 2.0)};
    turn[channel.axis] = std::sin(value / kDegreesInRadian / 2.0);
    pose.turn = product(pose.turn, turn);
    pose.degrees[channel.axis] = value;
  }

  Words words_;
  const ReadOptions& options_;
  Fault& fault_;
  std::vector<Joint> joints_;
  std::vector<Channel> channels_;
  std::size_t head_ = 0;
  std::vector<std::size_t> chain_;  // from the head to the root
  bool own_order_ = false;          // the head is the root and rotates about y, x, z
  double metres_ = 1.0;             // per unit
};

}  // namespace

double metres(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMetres:
      return 1.0;
    case LengthUnit::kCentimetres:
      return 0.01;
    case LengthUnit::kMillimetres:
      return 0.001;
    case LengthUnit::kInches:
      return 0.0254;
  }
  return 1.0;
}

const char* name(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMetres:
      return "metres";
    case LengthUnit::kCentimetres:
      return "centimetres";
    case LengthUnit::kMillimetres:
      return "millimetres";
    case LengthUnit::kInches:
      return "inches";
  }
  return "";
}

bool read_bvh(std::string_view text, const ReadOptions& options, Clip& clip, Fault& fault) {
  Clip read;
  read.frames.limit_bytes(max_clip_bytes(text.size()));
  if (!BvhReader(text, options, fault).read(read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::animation
