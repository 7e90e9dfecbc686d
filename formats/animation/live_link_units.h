// Which frame rate and which unit of angles a file of Live Link Face has: the file does not say it,
// but its values show it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/animation/live_link_csv.h"
#include "formats/animation/vocabulary.h"

namespace mien::formats {

// HH:MM:SS:FF.mmm
struct Timecode {
  std::int64_t second = 0;  // of the day
  double frame = 0.0;       // within the second
};

template <class Value>
struct Guess {
  Value value;
  bool seen;  // false: nothing shows it, and this is what is usual
};

// Counts values in bins of equal width from 0 on, so that a median takes no memory for each value.
class Histogram {
 public:
  Histogram(double width, std::size_t bins) : width_(width), counts_(bins) {}

  void add(double value);  // nothing where it has no bin
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] double median() const;  // the middle of its bin; of at least one value

 private:
  double width_;
  std::vector<std::size_t> counts_;
  std::size_t size_ = 0;
};

// Sees all timecodes of a file in turn.
class TimecodeRate {
 public:
  void add(const Timecode& timecode);

  // One of the usual rates, larger than every frame number. Where a second begins, the last frame
  // number before it and the usual step between rows show how many frames a second has.
  [[nodiscard]] Guess<double> rate() const;

 private:
  std::optional<Timecode> last_;
  double largest_ = 0.0;
  Histogram steps_{0.01, 6000};    // between rows of one second, frames
  Histogram before_{0.01, 10000};  // how much a number falls at the beginning of a second, frames
};

// Of a row, in the order of kRotationNames.
using Rotations = std::array<std::optional<double>, kRotationCount>;

// Sees the rotations of all rows and the controls beside them.
class AngleUnit {
 public:
  void add(const Rotations& rotations, const std::array<double, kControlCount>& controls);

  // Degrees where angles or steps are too large for radians. Elsewhere the eyes tell: how far they
  // turn for how much of eyeLook... is known.
  [[nodiscard]] Guess<RotationUnit> unit() const;
  // Whether any angle differs from 0.
  [[nodiscard]] bool matters() const { return largest_ > 0.0 || largest_roll_ > 0.0; }

 private:
  // Of a line through 0: sums of its points.
  struct Line {
    double xx = 0.0, xy = 0.0, yy = 0.0, largest = 0.0;
    void add(double x, const std::optional<double>& y);
  };

  [[nodiscard]] std::optional<double> eye_turn() const;

  std::array<Line, 4> eyes_;  // yaw, pitch of left and right
  Rotations last_;
  double largest_ = 0.0;  // of all but roll
  double largest_roll_ = 0.0;
  Histogram steps_{0.01, 1000};  // of the head, from row to row
};

}  // namespace mien::formats
