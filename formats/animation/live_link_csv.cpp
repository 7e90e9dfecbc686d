#include "formats/animation/live_link_csv.h"

#include <array>
#include <cmath>
#include <numbers>

#include "formats/animation/csv_cells.h"
#include "formats/animation/numbers.h"
#include "formats/animation/rotation.h"
#include "formats/animation/vocabulary.h"

namespace mien::formats {
namespace {

constexpr int kDecimals = 10;
constexpr int kValues = kControlCount + kRotationCount;

// Controls in the order of the file's columns.
constexpr std::array<std::size_t, kControlCount> kColumnOrder = [] {
  std::array<std::size_t, kControlCount> order{};
  for (std::size_t i = 0; i < kControlCount; ++i) {
    order[i] = i;
  }
  order[control("jawLeft")] = control("jawRight");
  order[control("jawRight")] = control("jawLeft");
  order[control("mouthLeft")] = control("mouthRight");
  order[control("mouthRight")] = control("mouthLeft");
  return order;
}();

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

std::string two_digits(std::int64_t value) {
  return std::string(value < 10 ? "0" : "").append(std::to_string(value));
}

// Of a day: hours begin anew after 24, and count back from there before 0.
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
      std::string name(kArkitNames[i]);
      name[0] = static_cast<char>(name[0] - 'a' + 'A');
      line.append(",").append(name);
    }
    for (const std::string_view name : kRotationNames) {
      line.append(",").append(name);
    }
    return line + "\n";
  }

  std::string frame(const Frame& frame) override {
    std::string line = timecode(frame.time_ns, options_.timecode_fps);
    if (shows_nothing(frame)) {
      return line + ",0" + std::string(kValues, ',') + "\n";
    }
    line.append(",").append(std::to_string(kValues));
    for (const std::size_t i : kColumnOrder) {
      line.append(",").append(fixed(or_zero(frame.controls[i]), kDecimals));
    }
    for (const double rotation : live_link_rotations(frame, options_.rotation)) {
      line.append(",").append(fixed(rotation, kDecimals));
    }
    return line + "\n";
  }

 private:
  LiveLinkOptions options_;
};

class LiveLinkReader {
 public:
  LiveLinkReader(std::string_view text, const LiveLinkOptions& options, Fault& fault)
      : table_(text), options_(options), fault_(fault) {}

  bool read(Clip& clip) {
    if (!header_.read(table_, fault_) || !find_columns()) {
      return false;
    }
    while (table_.next_row(fault_)) {
      Frame frame;
      frame.number = static_cast<std::int64_t>(clip.frames.size());
      if (!read_frame(frame, clip)) {
        return false;
      }
      clip.frames.push_back(frame);
    }
    return fault_.what.empty() &&
           (!clip.frames.empty() || fail(fault_, table_.line() + 1, 1, "there are no frames"));
  }

 private:
  bool find_columns() {
    time_ = header_.find("Timecode");
    count_ = header_.find("BlendshapeCount");
    if (!time_ || !count_) {
      return table_.fail_at(
          0, std::string("there is no column ") + (time_ ? "BlendshapeCount" : "Timecode"), fault_);
    }
    bool any = false;
    for (std::size_t i = 0; i < kControlCount; ++i) {
      controls_[i] = header_.find(kArkitNames[i]);
      any = any || controls_[i];
    }
    for (std::size_t i = 0; i < kRotationCount; ++i) {
      rotations_[i] = header_.find(kRotationNames[i]);
    }
    return any || table_.fail_at(0, "there is no column of a blend shape", fault_);
  }

  bool read_frame(Frame& frame, Clip& clip) {
    std::int64_t count = 0;
    if (!read_time(frame, clip.frames) || !read_count(count)) {
      return false;
    }
    if (count == 0) {
      frame.state = FaceState::kSearching;
      return true;
    }
    if (!check_width(table_, header_, fault_)) {
      return false;
    }
    for (std::size_t i = 0; i < kControlCount; ++i) {
      if (!read_clamped(table_, header_, controls_[i], frame.controls[i], clip.out_of_range,
                        fault_)) {
        return false;
      }
    }
    return read_rotations(frame);
  }

  bool read_count(std::int64_t& count) {
    if (*count_ >= table_.size() || !parse_number(table_.cell(*count_), count) || count < 0) {
      return table_.fail_at(*count_, "BlendshapeCount: is not a count", fault_);
    }
    return true;
  }

  bool read_time(Frame& frame, const std::vector<Frame>& before) {
    if (*time_ >= table_.size() || trimmed(table_.cell(*time_)).empty()) {
      const double row = static_cast<double>(frame.number) / options_.timecode_fps;
      if (!time_of(row, kSecond_ns, frame.time_ns)) {
        return table_.fail_at(*time_, "Timecode: is out of range", fault_);
      }
    } else if (!read_timecode(frame.time_ns)) {
      return false;
    }
    // Past midnight the hours begin anew: as many days later as bring it nearest.
    constexpr std::int64_t kHalfADay = 43200 * kSecond_ns;
    const std::int64_t back_ns = before.empty() ? 0 : before.back().time_ns - frame.time_ns;
    if (back_ns > kHalfADay) {
      frame.time_ns += (back_ns + kHalfADay - 1) / (2 * kHalfADay) * (2 * kHalfADay);
    }
    if (!time_allowed(frame.time_ns)) {
      return table_.fail_at(*time_, "Timecode: is out of range", fault_);
    }
    return before.empty() || frame.time_ns >= before.back().time_ns ||
           table_.fail_at(*time_, "Timecode: goes back in time", fault_);
  }

  // HH:MM:SS:FF.mmm; some have a ';' before the frames, or no thousandths.
  bool read_timecode(std::int64_t& time_ns) {
    const std::string& cell = table_.cell(*time_);
    std::string_view rest = trimmed(cell);
    std::array<double, 4> parts{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::size_t end = i + 1 < parts.size() ? rest.find_first_of(":;") : rest.size();
      if (end == std::string_view::npos || !parse_number(rest.substr(0, end), parts[i]) ||
          parts[i] < 0.0 || (i < 3 && parts[i] != std::floor(parts[i]))) {
        return table_.fail_at(*time_, "Timecode: " + quoted(cell) + " is not HH:MM:SS:FF.mmm",
                              fault_);
      }
      rest.remove_prefix(std::min(rest.size(), end + 1));
    }
    if (parts[0] > 99.0 || parts[1] >= 60.0 || parts[2] >= 60.0) {
      return table_.fail_at(*time_, "Timecode: " + quoted(cell) + " is no time of a day", fault_);
    }
    if (parts[3] >= options_.timecode_fps) {
      return table_.fail_at(*time_,
                            "Timecode: " + quoted(cell) + " has more frames than a second of " +
                                shortest(options_.timecode_fps),
                            fault_);
    }
    const double seconds = parts[0] * 3600.0 + parts[1] * 60.0 + parts[2];
    time_ns = std::llround(seconds) * 1'000'000'000 +
              std::llround(parts[3] / options_.timecode_fps * 1e9);
    return true;
  }

  bool read_rotations(Frame& frame) {
    std::array<std::optional<double>, kRotationCount> values;
    for (std::size_t i = 0; i < kRotationCount; ++i) {
      if (!read_cell(table_, header_, rotations_[i], values[i], fault_)) {
        return false;
      }
    }
    const auto head = three(values, 0), left = three(values, 3), right = three(values, 6);
    frame.head = head;
    if (left && right) {
      frame.eyes = {*left, *right};
    }
    return true;
  }

  // In the file's order yaw, pitch, roll; all of them or none.
  std::optional<Angles> three(const std::array<std::optional<double>, kRotationCount>& values,
                              std::size_t first) const {
    const double units = units_per_radian(options_.rotation);
    if (!values[first] || !values[first + 1] || !values[first + 2]) {
      return std::nullopt;
    }
    return Angles{(0.0 - *values[first + 1]) / units, *values[first] / units,
                  *values[first + 2] / units};
  }

  CsvTable table_;
  LiveLinkOptions options_;
  Fault& fault_;
  CsvHeader header_;
  Column time_, count_;
  std::array<Column, kControlCount> controls_;
  std::array<Column, kRotationCount> rotations_;
};

}  // namespace

std::array<double, kRotationCount> live_link_rotations(const Frame& frame, RotationUnit unit) {
  const auto eyes = frame.eyes ? frame.eyes : gaze(frame.controls);
  const Angles turns[] = {frame.head.value_or(Angles()), eyes ? (*eyes)[0] : Angles(),
                          eyes ? (*eyes)[1] : Angles()};
  const double units = units_per_radian(unit);
  std::array<double, kRotationCount> rotations{};
  std::size_t i = 0;
  for (const Angles& turn : turns) {
    for (const double angle : {turn.yaw, 0.0 - turn.pitch, turn.roll}) {
      rotations[i++] = units * angle;
    }
  }
  return rotations;
}

bool shows_nothing(const Frame& frame) {
  for (const double value : frame.controls) {
    if (or_zero(value) != 0.0) {
      return false;
    }
  }
  return !frame.head && frame.state == FaceState::kSearching;
}

std::unique_ptr<AnimationWriter> live_link_csv_writer(const LiveLinkOptions& options) {
  return std::make_unique<LiveLinkCsvWriter>(options);
}

bool read_live_link_csv(std::string_view text, const LiveLinkOptions& options, Clip& clip,
                        Fault& fault) {
  Clip read;
  if (!LiveLinkReader(text, options, fault).read(read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::formats
