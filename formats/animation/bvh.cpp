#include "formats/animation/bvh.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "formats/animation/numbers.h"
#include "formats/animation/resample.h"
#include "formats/animation/rotation.h"

namespace mien::formats {
namespace {

constexpr int kDecimals = 6;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::int64_t kMaxFrames = 10'000'000;

using Vector = std::array<double, 3>;

class BvhWriter : public WholeClipWriter {
 protected:
  std::string whole(const std::vector<Frame>& frames) override {
    const double step_s = mean_step_s(frames);
    const std::vector<Frame> even =
        evenly_spaced(frames) ? frames : resampled(frames, 1.0 / step_s, frames.front().time_ns);
    std::string text =
        "HIERARCHY\n"
        "ROOT Head\n"
        "{\n"
        "\tOFFSET 0.0 0.0 0.0\n"
        "\tCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
        "\tEnd Site\n"
        "\t{\n"
        "\t\tOFFSET 0.0 0.1 0.0\n"
        "\t}\n"
        "}\n"
        "MOTION\n"
        "Frames: " +
        std::to_string(even.size()) + "\nFrame Time: " + fixed(step_s, 9) + "\n";
    Angles head;
    Vector position{};
    for (const Frame& frame : even) {
      head = frame.head.value_or(head);
      position = frame.position_m.value_or(position);
      for (const double metres : position) {
        text += fixed(metres, kDecimals) + " ";
      }
      text += fixed(kDegrees * head.yaw, kDecimals) + " " +
              fixed(kDegrees * head.pitch, kDecimals) + " " +
              fixed(kDegrees * head.roll, kDecimals) + "\n";
    }
    return text;
  }
};

// Words of the text, each with its place.
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

  // At the last word.
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
  std::size_t parent;  // its own index: the root
  std::string name;
  Vector offset;
};

Vector rotated(const Quaternion& q, const Vector& v) {
  const Vector u = {q[0], q[1], q[2]};
  const auto cross = [](const Vector& a, const Vector& b) -> Vector {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vector once = cross(u, v);
  const Vector twice = cross(u, once);
  Vector turned;
  for (std::size_t i = 0; i < 3; ++i) {
    turned[i] = v[i] + 2.0 * (q[3] * once[i] + twice[i]);
  }
  return turned;
}

class Reader {
 public:
  Reader(std::string_view text, Fault& fault) : words_(text), fault_(fault) {}

  bool read(Clip& clip) {
    return expect("HIERARCHY") && expect("ROOT") && read_joint(0, 0) && find_head() &&
           read_motion(clip);
  }

 private:
  bool expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    return same_name(word, wanted) ||
           words_.fail_here(quoted(wanted) + " is expected instead of " + quoted(word), fault_);
  }

  bool number(double& value) {
    const std::string_view word = words_.next();
    return parse_number(word, value) || words_.fail_here(quoted(word) + " is not a number", fault_);
  }

  bool vector(Vector& value) { return number(value[0]) && number(value[1]) && number(value[2]); }

  // From its name to its '}'.
  bool read_joint(std::size_t parent, int depth) {
    constexpr int kMaxDepth = 100;
    if (depth > kMaxDepth) {
      return words_.fail_here("too deeply nested", fault_);
    }
    const std::size_t self = joints_.size();
    joints_.push_back({parent, std::string(words_.next()), {}});
    Vector offset{};
    if (!expect("{") || !expect("OFFSET") || !vector(offset) || !expect("CHANNELS") ||
        !read_channels(self)) {
      return false;
    }
    joints_[self].offset = offset;
    for (std::string_view word = words_.next(); word != "}"; word = words_.next()) {
      if (same_name(word, "JOINT")) {
        if (!read_joint(self, depth + 1)) {
          return false;
        }
      } else if (same_name(word, "End")) {
        if (!expect("Site") || !expect("{") || !expect("OFFSET") || !vector(offset) ||
            !expect("}")) {
          return false;
        }
      } else {
        return words_.fail_here("JOINT, End or '}' is expected instead of " + quoted(word), fault_);
      }
    }
    return true;
  }

  bool read_channels(std::size_t joint) {
    std::int64_t count = 0;
    const std::string_view word = words_.next();
    if (!parse_number(word, count) || count < 0 || count > 6) {
      return words_.fail_here(quoted(word) + " is not a number of channels", fault_);
    }
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string_view name = words_.next();
      const bool rotates = name.size() == 9 && same_name(name.substr(1), "rotation");
      const bool moves = name.size() == 9 && same_name(name.substr(1), "position");
      const std::size_t axis = name.empty() ? 3 : std::string_view("xyz").find(to_lower(name[0]));
      if ((!rotates && !moves) || axis > 2) {
        return words_.fail_here(quoted(name) + " is not a channel", fault_);
      }
      channels_.push_back({joint, axis, rotates});
    }
    return true;
  }

  bool find_head() {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const std::string_view name = joints_[i].name;
      if (name.size() >= 4 && same_name(name.substr(name.size() - 4), "head")) {
        head_ = i;
        return true;
      }
    }
    return true;
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
      return words_.fail_here(quoted(word) + " is not a number of frames", fault_);
    }
    double step_s = 0.0;
    if (!expect("Frame") || !expect("Time:") || !number(step_s)) {
      return false;
    }
    if (step_s <= 0.0 || step_s > 3600.0) {
      return words_.fail_here("the time of a frame is out of range", fault_);
    }
    for (std::int64_t i = 0; i < count; ++i) {
      Frame frame;
      frame.number = i;
      if (!time_of(static_cast<double>(i) * step_s, kSecond_ns, frame.time_ns)) {
        return words_.fail_here("the frames last too long", fault_);
      }
      if (!read_pose(frame)) {
        return false;
      }
      clip.frames.push_back(std::move(frame));
    }
    return words_.next().empty() ||
           words_.fail_here("there is more than " + std::to_string(count) + " frames", fault_);
  }

  bool read_pose(Frame& frame) {
    std::vector<Quaternion> turns(joints_.size(), {0.0, 0.0, 0.0, 1.0});
    std::vector<Vector> moves(joints_.size(), Vector{});
    std::vector<std::array<double, 3>> degrees(joints_.size(), Vector{});
    bool moved = false;
    for (const Channel& channel : channels_) {
      double value = 0.0;
      if (!number(value)) {
        return false;
      }
      if (!channel.rotates) {
        moves[channel.joint][channel.axis] = value;
        moved = true;
        continue;
      }
      Quaternion turn = {0.0, 0.0, 0.0, std::cos(value / kDegrees / 2.0)};
      turn[channel.axis] = std::sin(value / kDegrees / 2.0);
      turns[channel.joint] = product(turns[channel.joint], turn);
      degrees[channel.joint][channel.axis] = value;
    }
    Quaternion turn = {0.0, 0.0, 0.0, 1.0};
    Vector place{};
    for (std::size_t i = head_;; i = joints_[i].parent) {
      Vector shift;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        shift[axis] = joints_[i].offset[axis] + moves[i][axis] + rotated(turns[i], place)[axis];
      }
      place = shift;
      turn = product(turns[i], turn);
      if (joints_[i].parent == i) {
        break;
      }
    }
    // A root in our own order says its angles itself, to the digit.
    const Vector& own = degrees[head_];
    frame.head = joints_[head_].parent == head_ && in_own_order()
                     ? Angles{own[0] / kDegrees, own[1] / kDegrees, own[2] / kDegrees}
                     : angles(turn);
    if (moved) {
      frame.position_m = place;
    }
    return true;
  }

  // Whether the head turns about y, x, z.
  bool in_own_order() const {
    std::string order;
    for (const Channel& channel : channels_) {
      if (channel.rotates && channel.joint == head_) {
        order += "xyz"[channel.axis];
      }
    }
    return order == "yxz";
  }

  Words words_;
  Fault& fault_;
  std::vector<Joint> joints_;
  std::vector<Channel> channels_;
  std::size_t head_ = 0;
};

}  // namespace

std::unique_ptr<AnimationWriter> bvh_writer() { return std::make_unique<BvhWriter>(); }

bool read_bvh(std::string_view text, Clip& clip, Fault& fault) {
  Clip read;
  if (!Reader(text, fault).read(read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::formats
