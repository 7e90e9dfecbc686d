// Reads CSV of Live Link Face.
#include "apps/animation/live_link_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "apps/animation/csv_cells.h"
#include "apps/animation/live_link_units.h"
#include "apps/animation/numbers.h"
#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {
namespace {

// Parses HH:MM:SS:FF.mmm; some files have a ';' before the frames, or no thousandths. The frame
// rate, which limits the frames, is checked elsewhere.
bool parse_timecode(std::string_view text, Timecode& timecode) {
  std::string_view rest = trimmed(text);
  std::array<double, 4> parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t end = i + 1 < parts.size() ? rest.find_first_of(":;") : rest.size();
    if (end == std::string_view::npos || !parse_number(rest.substr(0, end), parts[i]) ||
        parts[i] < 0.0 || (i < 3 && parts[i] != std::floor(parts[i]))) {
      return false;
    }
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  // -1: a timecode, but not a time of day.
  const bool of_a_day = parts[0] <= 99.0 && parts[1] < 60.0 && parts[2] < 60.0;
  timecode = {of_a_day ? std::llround(parts[0] * 3600.0 + parts[1] * 60.0 + parts[2]) : -1,
              parts[3]};
  return true;
}

class LiveLinkReader {
 public:
  LiveLinkReader(std::string_view text, const ReadOptions& options, Fault& fault)
      : text_(text), table_(text), options_(options), fault_(fault) {}

  bool read(Clip& clip) {
    if (!header_.read(table_, fault_) || !find_columns()) {
      return false;
    }
    find_units(clip);
    while (table_.next_row(fault_)) {
      Frame frame;
      frame.number = number_++;
      if (!read_frame(frame, clip) || !add_frame(clip, frame, table_.line(), fault_)) {
        return false;
      }
      last_ns_ = frame.time_ns;
    }
    return fault_.what.empty() && (last_ns_ || fail(fault_, table_.line() + 1, 1, "no frames"));
  }

 private:
  bool find_columns() {
    time_ = header_.find("Timecode");
    count_ = header_.find("BlendshapeCount");
    if (!time_ || !count_) {
      return table_.fail_at(
          0, std::string("missing column ") + (time_ ? "BlendshapeCount" : "Timecode"), fault_);
    }
    bool any = false;
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      controls_[i] = header_.find(formats::kArkitNames[i]);
      any = any || controls_[i];
    }
    for (std::size_t i = 0; i < formats::kRotationCount; ++i) {
      rotations_[i] = header_.find(formats::kRotationNames[i]);
    }
    return any || table_.fail_at(0, "no column with a blend shape", fault_);
  }

  // Detects the units that the options leave open from all rows. Errors in rows are reported later,
  // when they are read.
  void find_units(Clip& clip) {
    TimecodeRate rate;
    AngleUnit angle;
    CsvTable table(text_);
    Fault ignored;
    bool more = !options_.timecode_fps || !options_.rotation ? table.next_row(ignored) : false;
    while (more && table.next_row(ignored)) {
      add_row(table, rate, angle);
    }
    const Guess<double> fps =
        options_.timecode_fps ? Guess<double>{*options_.timecode_fps, true} : rate.rate();
    const Guess<RotationUnit> unit =
        options_.rotation ? Guess<RotationUnit>{*options_.rotation, true} : angle.unit();
    fps_ = fps.value;
    unit_ = unit.value;
    if (!options_.timecode_fps) {
      clip.notes.push_back("timecode: " + shortest(fps_) + " frames per second, " +
                           (fps.detected ? "detected" : "default") + " (--from-llf-fps)");
    }
    if (!options_.rotation && angle.matters()) {
      clip.notes.push_back(std::string("rotations: ") + name(unit_) + ", " +
                           (unit.detected ? "detected" : "default") + " (--from-llf-rot)");
    }
  }

  void add_row(CsvTable& table, TimecodeRate& rate, AngleUnit& angle) const {
    Timecode timecode;
    if (*time_ < table.size() && parse_timecode(table.cell(*time_), timecode)) {
      rate.add(timecode);
    }
    std::array<double, formats::kControlCount> controls{};
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      controls[i] = number_in(table, controls_[i]).value_or(0.0);
    }
    Rotations rotations;
    for (std::size_t i = 0; i < formats::kRotationCount; ++i) {
      rotations[i] = number_in(table, rotations_[i]);
    }
    angle.add(rotations, controls);
  }

  static std::optional<double> number_in(CsvTable& table, Column column) {
    double value = 0.0;
    const bool is_number = column && *column < table.size() && table.number(*column, value);
    return is_number ? std::optional(value) : std::nullopt;
  }

  bool read_frame(Frame& frame, Clip& clip) {
    std::int64_t count = 0;
    if (!read_time(frame) || !read_count(count)) {
      return false;
    }
    if (count == 0) {
      frame.state = FaceState::kSearching;
      return true;
    }
    if (!check_width(table_, header_, fault_)) {
      return false;
    }
    for (std::size_t i = 0; i < formats::kControlCount; ++i) {
      if (!read_clamped(table_, header_, controls_[i], frame.controls[i], clip.out_of_range,
                        fault_)) {
        return false;
      }
    }
    return read_rotations(frame);
  }

  bool read_count(std::int64_t& count) {
    if (*count_ >= table_.size() || !parse_number(table_.cell(*count_), count) || count < 0) {
      return table_.fail_at(*count_, "BlendshapeCount: invalid count", fault_);
    }
    return true;
  }

  bool read_time(Frame& frame) {
    if (*time_ >= table_.size() || trimmed(table_.cell(*time_)).empty()) {
      const double row = static_cast<double>(frame.number) / fps_;
      if (!time_of(row, kSecond_ns, frame.time_ns)) {
        return table_.fail_at(*time_, "Timecode: out of range", fault_);
      }
    } else if (!read_timecode(frame.time_ns)) {
      return false;
    }
    // After midnight the hours restart: adds the days that bring the time nearest to the previous
    // one.
    constexpr std::int64_t kHalfADay = 43200 * kSecond_ns;
    const std::int64_t back_ns = last_ns_ ? *last_ns_ - frame.time_ns : 0;
    if (back_ns > kHalfADay) {
      frame.time_ns += (back_ns + kHalfADay - 1) / (2 * kHalfADay) * (2 * kHalfADay);
    }
    if (!time_allowed(frame.time_ns)) {
      return table_.fail_at(*time_, "Timecode: out of range", fault_);
    }
    return !last_ns_ || frame.time_ns >= *last_ns_ ||
           table_.fail_at(*time_, "Timecode: decreasing time", fault_);
  }

  bool read_timecode(std::int64_t& time_ns) {
    const std::string cell = "Timecode: " + quoted(table_.cell(*time_));
    Timecode timecode;
    if (!parse_timecode(table_.cell(*time_), timecode)) {
      return table_.fail_at(*time_, cell + " is not HH:MM:SS:FF.mmm", fault_);
    }
    if (timecode.second < 0) {
      return table_.fail_at(*time_, cell + " is not a time of day", fault_);
    }
    if (timecode.frame >= fps_) {
      return table_.fail_at(
          *time_,
          cell + " has more frames than a second of " + shortest(fps_) + " (--from-llf-fps)",
          fault_);
    }
    time_ns = timecode.second * kSecond_ns + std::llround(timecode.frame / fps_ * 1e9);
    return true;
  }

  bool read_rotations(Frame& frame) {
    Rotations values;
    for (std::size_t i = 0; i < formats::kRotationCount; ++i) {
      if (!read_cell(table_, header_, rotations_[i], values[i], fault_) ||
          !check_angle(i, values[i])) {
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

  bool check_angle(std::size_t which, const std::optional<double>& value) {
    const double half_turn = std::numbers::pi * units_per_radian(unit_);
    if (!value || std::abs(*value) <= half_turn * (1.0 + 1e-6)) {
      return true;
    }
    return table_.fail_at(*rotations_[which],
                          std::string(formats::kRotationNames[which]) +
                              ": more than half a turn in " + name(unit_) + " (got " +
                              shortest(*value) + ", expected " + fixed(-half_turn, 2) + " to " +
                              fixed(half_turn, 2) + "; --from-llf-rot rad, norm180 or deg)",
                          fault_);
  }

  // In the file's order yaw, pitch, roll; all of them or none.
  [[nodiscard]] std::optional<Angles> three(const Rotations& values, std::size_t first) const {
    const double units = units_per_radian(unit_);
    if (!values[first] || !values[first + 1] || !values[first + 2]) {
      return std::nullopt;
    }
    return Angles{(0.0 - *values[first + 1]) / units, *values[first] / units,
                  *values[first + 2] / units};
  }

  std::string_view text_;
  CsvTable table_;
  const ReadOptions& options_;
  Fault& fault_;
  CsvHeader header_;
  Column time_, count_;
  std::array<Column, formats::kControlCount> controls_;
  std::array<Column, formats::kRotationCount> rotations_;
  double fps_ = 60.0;
  RotationUnit unit_ = RotationUnit::kRadians;
  std::int64_t number_ = 0;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace

bool read_live_link_csv(std::string_view text, const ReadOptions& options, Clip& clip,
                        Fault& fault) {
  Clip read;
  read.frames.limit_bytes(max_clip_bytes(text.size()));
  if (!LiveLinkReader(text, options, fault).read(read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::animation
