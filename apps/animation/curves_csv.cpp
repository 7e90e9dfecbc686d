// Reads and writes curves as CSV.
#include "apps/animation/curves_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "apps/animation/csv_cells.h"
#include "apps/animation/csv_row.h"
#include "apps/animation/facs_map.h"
#include "apps/animation/numbers.h"
#include "formats/vocabulary/visemes.h"
#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {
namespace {

constexpr std::array<std::string_view, 4> kBoxNames = {"x", "y", "w", "h"};
constexpr std::array<std::string_view, 3> kAngleNames = {"pitch_rad", "yaw_rad", "roll_rad"};
constexpr std::array<std::string_view, 3> kPositionNames = {"tx_m", "ty_m", "tz_m"};
constexpr std::array kStates = {FaceState::kSearching, FaceState::kTracking, FaceState::kLost};

// Buffer for the longest row; each cell is a number or a short word.
class Row : public CsvRow {
 public:
  Row() : CsvRow(room_) {}

 private:
  std::array<char, CsvRow::kMaxNumberBytes*(16 + formats::kControlCount)> room_;
};

using Names = std::span<const std::string_view>;

Names names_of(Weights weights) {
  switch (weights) {
    case Weights::kControls:
      return formats::kArkitNames;
    case Weights::kFacs:
      return formats::kFacsNames;
    case Weights::kFacsLevel1:
      return formats::kFacsLevel1Names;
    case Weights::kVisemes:
      return formats::kVisemeNames;
  }
  return {};
}

// Weights in the order of names_of, from the original vocabulary if the frame has it.
std::vector<double> weights_of(const Frame& frame, Weights weights) {
  if (weights == Weights::kControls) {
    return {frame.controls.begin(), frame.controls.end()};
  }
  if (weights == Weights::kVisemes) {
    const auto mixed = formats::visemes_of(frame.controls);
    return !frame.visemes.empty() ? frame.visemes : std::vector(mixed.begin(), mixed.end());
  }
  const auto mapped = facs_of(frame.controls);
  std::vector<double> facs =
      !frame.facs.empty() ? frame.facs : std::vector(mapped.begin(), mapped.end());
  if (weights == Weights::kFacs) {
    return facs;
  }
  std::vector<double> level_1;
  level_1.reserve(formats::kFacsLevel1Names.size());
  for (const std::string_view unit : formats::kFacsLevel1Names) {
    level_1.push_back(facs[formats::index_of(unit, formats::kFacsNames)]);
  }
  return level_1;
}

class CurvesCsvWriter : public AnimationWriter {
 public:
  CurvesCsvWriter(Weights weights, bool several_faces)
      : weights_(weights), several_faces_(several_faces) {}

  std::string begin() override {
    Row row;
    row.add(std::string_view("frame"));
    if (several_faces_) {
      row.add(std::string_view("face_id"));
    }
    for (const std::string_view name : {"t_ms", "status", "face_prob", "lod", "vad"}) {
      row.add(name);
    }
    add_names(row, kBoxNames);
    add_names(row, kAngleNames);
    add_names(row, kPositionNames);
    add_names(row, names_of(weights_));
    return std::string(row.finish());
  }

  std::string frame(const Frame& frame) override {
    Row row;
    row.add(frame.number);
    if (several_faces_) {
      row.add(frame.face_id);
    }
    row.add(frame.time_ms());
    row.add(std::string_view(name(frame.state)));
    row.add(frame.face_probability);
    frame.lod != 0 ? row.add(frame.lod) : row.add_empty();
    row.add(frame.voice_activity);
    add_or_empty(row, frame.box);
    add_or_empty(row, frame.head ? std::optional(std::array{frame.head->pitch, frame.head->yaw,
                                                            frame.head->roll})
                                 : std::nullopt);
    add_or_empty(row, frame.position_m);
    for (const double value : weights_of(frame, weights_)) {
      row.add(value);
    }
    return std::string(row.finish());
  }

 private:
  static void add_names(CsvRow& row, Names names) {
    for (const std::string_view name : names) {
      row.add(name);
    }
  }

  template <std::size_t N>
  static void add_or_empty(CsvRow& row, const std::optional<std::array<double, N>>& values) {
    for (std::size_t i = 0; i < N; ++i) {
      values ? row.add((*values)[i]) : row.add_empty();
    }
  }

  Weights weights_;
  bool several_faces_;
};

class CurvesReader {
 public:
  CurvesReader(std::string_view text, Fault& fault) : table_(text), fault_(fault) {}

  bool read(Clip& clip) {
    if (!header_.read(table_, fault_) || !find_columns()) {
      return false;
    }
    while (table_.next_row(fault_)) {
      Frame frame;
      frame.number = static_cast<std::int64_t>(clip.frames.size());
      if (!check_width(table_, header_, fault_) || !read_frame(frame) ||
          !goes_on(clip.frames, frame) || !add_frame(clip, frame, table_.line(), fault_)) {
        return false;
      }
    }
    return fault_.what.empty() &&
           (!clip.frames.empty() || fail(fault_, table_.line() + 1, 1, "no frames"));
  }

 private:
  bool find_columns() {
    time_ = header_.find("t_ms");
    if (!time_) {
      return table_.fail_at(0, "t_ms: missing column", fault_);
    }
    std::size_t max_count = 0;
    for (const Weights candidate : {Weights::kControls, Weights::kFacs, Weights::kVisemes}) {
      std::size_t there = 0;
      for (const std::string_view name : names_of(candidate)) {
        there += header_.find(name) ? 1 : 0;
      }
      if (there > max_count) {
        max_count = there;
        weights_ = candidate;
      }
    }
    for (const std::string_view name : names_of(weights_)) {
      columns_.push_back(header_.find(name));
    }
    return max_count > 0 ||
           table_.fail_at(
               0,
               "no column with a control (eyeBlinkLeft ... tongueOut), a Roblox unit or a viseme",
               fault_);
  }

  bool read_frame(Frame& frame) {
    return read_time(frame) && read_integer("frame", frame.number) &&
           read_integer("face_id", frame.face_id) && read_integer("lod", frame.lod) &&
           read_state(frame.state) &&
           read_fraction(table_, header_, header_.find("face_prob"), frame.face_probability,
                         fault_) &&
           read_fraction(table_, header_, header_.find("vad"), frame.voice_activity, fault_) &&
           read_all(kBoxNames, frame.box) && read_all(kPositionNames, frame.position_m) &&
           read_head(frame) && read_weights(frame);
  }

  bool read_time(Frame& frame) {
    std::optional<double> t_ms;
    if (!read_cell(table_, header_, time_, t_ms, fault_)) {
      return false;
    }
    if (!t_ms) {
      return table_.fail_at(*time_, "t_ms: empty", fault_);
    }
    return time_of(*t_ms, kMillisecond_ns, frame.time_ns) ||
           table_.fail_at(*time_, "t_ms: " + quoted(table_.cell(*time_)) + " is out of range",
                          fault_);
  }

  bool goes_on(const FrameSequence& before, const Frame& frame) {
    return before.empty() || frame.time_ns >= before.last_time_ns() ||
           table_.fail_at(*time_, "t_ms: decreasing time", fault_);
  }

  bool read_integer(std::string_view name, std::int64_t& value) {
    const Column column = header_.find(name);
    if (!column || trimmed(table_.cell(*column)).empty() ||
        parse_number(table_.cell(*column), value)) {
      return true;
    }
    return table_.fail_at(
        *column, std::string(name) + ": " + quoted(table_.cell(*column)) + " is not an integer",
        fault_);
  }

  bool read_state(FaceState& state) {
    const Column column = header_.find("status");
    if (!column) {
      return true;
    }
    for (const FaceState candidate : kStates) {
      if (trimmed(table_.cell(*column)) == name(candidate)) {
        state = candidate;
        return true;
      }
    }
    return table_.fail_at(*column,
                          "status: " + quoted(table_.cell(*column)) +
                              " is unknown, expected searching, tracking or lost",
                          fault_);
  }

  // All columns or none.
  template <std::size_t N>
  bool read_all(const std::array<std::string_view, N>& names,
                std::optional<std::array<double, N>>& values) {
    std::array<double, N> read{};
    std::size_t there = 0;
    for (std::size_t i = 0; i < N; ++i) {
      std::optional<double> value;
      if (!read_cell(table_, header_, header_.find(names[i]), value, fault_)) {
        return false;
      }
      read[i] = value.value_or(0.0);
      there += value ? 1 : 0;
    }
    if (there == N) {
      values = read;
    }
    return true;
  }

  bool read_head(Frame& frame) {
    std::optional<std::array<double, 3>> head;
    if (!read_all(kAngleNames, head)) {
      return false;
    }
    for (std::size_t i = 0; head && i < kAngleNames.size(); ++i) {
      if (std::abs((*head)[i]) > 2.0 * std::numbers::pi) {
        return table_.fail_at(
            *header_.find(kAngleNames[i]),
            std::string(kAngleNames[i]) + ": more than a full turn; angles are in radians", fault_);
      }
    }
    if (head) {
      frame.head = {(*head)[0], (*head)[1], (*head)[2]};
    }
    return true;
  }

  bool read_weights(Frame& frame) {
    std::vector<double> values(columns_.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!read_fraction(table_, header_, columns_[i], values[i], fault_)) {
        return false;
      }
    }
    if (weights_ == Weights::kControls) {
      std::copy(values.begin(), values.end(), frame.controls.begin());
    } else if (weights_ == Weights::kFacs) {
      frame.facs = values;
      frame.controls = controls_of_facs(std::span<const double, formats::kFacsCount>(values));
    } else {
      frame.visemes = values;
      frame.controls =
          formats::controls_of_visemes(std::span<const double, formats::kVisemeCount>(values));
    }
    return true;
  }

  CsvTable table_;
  Fault& fault_;
  CsvHeader header_;
  Column time_;
  Weights weights_ = Weights::kControls;
  std::vector<Column> columns_;
};

}  // namespace

std::unique_ptr<AnimationWriter> curves_csv_writer(Weights weights, bool several_faces) {
  return std::make_unique<CurvesCsvWriter>(weights, several_faces);
}

bool read_curves_csv(std::string_view text, Clip& clip, Fault& fault) {
  Clip read;
  read.frames.limit_bytes(max_clip_bytes(text.size()));
  if (!CurvesReader(text, fault).read(read)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::animation
