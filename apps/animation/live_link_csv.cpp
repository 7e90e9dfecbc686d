// Writes CSV of Live Link Face.
#include "apps/animation/live_link_csv.h"

#include <array>
#include <cmath>
#include <numbers>

#include "apps/animation/numbers.h"
#include "apps/animation/rotation.h"
#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {
namespace {

constexpr int kDecimals = 10;
constexpr int kValues = formats::kControlCount + formats::kRotationCount;

// Controls in the order of the file's columns.
constexpr std::array<std::size_t, formats::kControlCount> kColumnOrder = [] {
  std::array<std::size_t, formats::kControlCount> order{};
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    order[i] = i;
  }
  order[formats::control("jawLeft")] = formats::control("jawRight");
  order[formats::control("jawRight")] = formats::control("jawLeft");
  order[formats::control("mouthLeft")] = formats::control("mouthRight");
  order[formats::control("mouthRight")] = formats::control("mouthLeft");
  return order;
}();

std::string two_digits(std::int64_t value) {
  return std::string(value < 10 ? "0" : "").append(std::to_string(value));
}

// Within a day: hours restart after 24, and negative times count back from 24.
std::string timecode(std::int64_t time_ns, double fps) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  constexpr std::int64_t kDay = 86400;
  const std::int64_t floor_s = time_ns / kSecond - (time_ns % kSecond < 0 ? 1 : 0);
  const auto within = static_cast<double>(time_ns - floor_s * kSecond) * 1e-9;
  std::int64_t thousandths = std::llround(within * fps * 1000.0);  // of a frame
  std::int64_t seconds = floor_s;
  if (thousandths >= std::llround(fps * 1000.0)) {
    thousandths = 0;
    ++seconds;
  }
  seconds = (seconds % kDay + kDay) % kDay;
  std::string milli = std::to_string(thousandths % 1000);
  milli.insert(0, 3 - milli.size(), '0');
  return two_digits(seconds / 3600) + ":" + two_digits(seconds / 60 % 60) + ":" +
         two_digits(seconds % 60) + ":" + two_digits(thousandths / 1000) + "." + milli;
}

class LiveLinkCsvWriter : public AnimationWriter {
 public:
  explicit LiveLinkCsvWriter(const LiveLinkOptions& options) : options_(options) {}

  std::string begin() override {
    std::string line = "Timecode,BlendshapeCount";
    for (const std::size_t i : kColumnOrder) {
      std::string name(formats::kArkitNames[i]);
      name[0] = static_cast<char>(name[0] - 'a' + 'A');
      line.append(",").append(name);
    }
    for (const std::string_view name : formats::kRotationNames) {
      line.append(",").append(name);
    }
    return line + "\n";
  }

  std::string frame(const Frame& frame) override {
    std::string line = timecode(frame.time_ns, options_.timecode_fps);
    if (is_blank(frame)) {
      return line + ",0" + std::string(kValues, ',') + "\n";
    }
    line.append(",").append(std::to_string(kValues));
    for (const std::size_t i : kColumnOrder) {
      line.append(",").append(fixed(formats::or_zero(frame.controls[i]), kDecimals));
    }
    for (const double rotation : live_link_rotations(frame, options_.rotation)) {
      line.append(",").append(fixed(rotation, kDecimals));
    }
    return line + "\n";
  }

 private:
  LiveLinkOptions options_;
};

}  // namespace

double units_per_radian(RotationUnit unit) {
  switch (unit) {
    case RotationUnit::kRadians:
      return 1.0;
    case RotationUnit::kDegreesBy180:
      return 1.0 / std::numbers::pi;
    case RotationUnit::kDegrees:
      return 180.0 / std::numbers::pi;
  }
  return 1.0;
}

const char* name(RotationUnit unit) {
  switch (unit) {
    case RotationUnit::kRadians:
      return "radians";
    case RotationUnit::kDegreesBy180:
      return "degrees / 180";
    case RotationUnit::kDegrees:
      return "degrees";
  }
  return "";
}

std::array<double, formats::kRotationCount> live_link_rotations(const Frame& frame,
                                                                RotationUnit unit) {
  const auto eyes = frame.eyes ? frame.eyes : gaze(frame.controls);
  const Angles turns[] = {frame.head.value_or(Angles()), eyes ? (*eyes)[0] : Angles(),
                          eyes ? (*eyes)[1] : Angles()};
  const double units = units_per_radian(unit);
  std::array<double, formats::kRotationCount> rotations{};
  std::size_t i = 0;
  for (const Angles& turn : turns) {
    for (const double angle : {turn.yaw, 0.0 - turn.pitch, turn.roll}) {
      rotations[i++] = units * angle;
    }
  }
  return rotations;
}

bool is_blank(const Frame& frame) {
  for (const double value : frame.controls) {
    if (formats::or_zero(value) != 0.0) {
      return false;
    }
  }
  return !frame.head && frame.state == FaceState::kSearching;
}

std::unique_ptr<AnimationWriter> live_link_csv_writer(const LiveLinkOptions& options) {
  return std::make_unique<LiveLinkCsvWriter>(options);
}

}  // namespace mien::animation
