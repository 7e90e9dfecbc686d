// Detects the frame rate and the unit of angles of a Live Link Face file from its values, because
// the file does not specify them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/animation/live_link_csv.h"
#include "formats/vocabulary/vocabulary.h"

namespace mien::animation {

// HH:MM:SS:FF.mmm
struct Timecode {
  std::int64_t second = 0;  // of the day
  double frame = 0.0;       // within the second
};

template <class Value>
struct Guess {
  Value value;
  bool detected;  // false: the value is the default
};

// Counts values in bins of equal width from 0 on, so that a median needs constant memory.
class Histogram {
 public:
  Histogram(double width, std::size_t bins) : width_(width), counts_(bins) {}

  void add(double value);  // ignored outside the bins
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] double median() const;  // the centre of its bin; requires at least one value

 private:
  double width_;
  std::vector<std::size_t> counts_;
  std::size_t size_ = 0;
};

// Processes all timecodes of a file in order.
class TimecodeRate {
 public:
  void add(const Timecode& timecode);

  // A common rate larger than every frame number. At the start of a second, the last frame number
  // before it and the typical step between rows determine the number of frames per second.
  [[nodiscard]] Guess<double> rate() const;

 private:
  std::optional<Timecode> last_;
  double largest_ = 0.0;
  Histogram steps_{0.01, 6000};    // frames between rows within a second
  Histogram before_{0.01, 10000};  // decrease of the frame number at the start of a second
};

// Of a row, in the order of kRotationNames.
using Rotations = std::array<std::optional<double>, formats::kRotationCount>;

// Processes rotations and controls of all rows.
class AngleUnit {
 public:
  void add(const Rotations& rotations, const std::array<double, formats::kControlCount>& controls);

  // Degrees if angles or steps are too large for radians. Otherwise the eyes decide: their rotation
  // for a given eyeLook... is known.
  [[nodiscard]] Guess<RotationUnit> unit() const;
  // Whether any angle differs from 0.
  [[nodiscard]] bool matters() const { return largest_ > 0.0 || largest_roll_ > 0.0; }

 private:
  // A line through 0, as sums over its points.
  struct Line {
    double xx = 0.0, xy = 0.0, yy = 0.0, largest = 0.0;
    void add(double x, const std::optional<double>& y);
  };

  [[nodiscard]] std::optional<double> eye_turn() const;

  std::array<Line, 4> eyes_;  // yaw, pitch of left and right
  Rotations last_;
  double largest_ = 0.0;  // of all angles except roll
  double largest_roll_ = 0.0;
  Histogram steps_{0.01, 1000};  // of the head, between rows
};

}  // namespace mien::animation
