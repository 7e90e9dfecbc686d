// Detects frame rates and units of angles.
#include "apps/animation/live_link_units.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::animation {
namespace {

constexpr std::array kRates = {24.0, 25.0, 30.0, 48.0, 50.0, 60.0};
constexpr double kDefaultRate = 60.0;
constexpr std::size_t kMinSteps = 5;

constexpr double kHalfTurn = std::numbers::pi;
// Beyond this, a head no longer shows its face.
constexpr double kMaxAngle_rad = 2.1;
// Largest typical step between rows.
constexpr double kMaxStep_rad = 0.35;
constexpr std::size_t kMinHeadSteps = 10;

// Rotation of an eye in radians while eyeLook... goes from 0 to 1; measured on captures.
constexpr double kEyeTurn_rad = 0.485;
constexpr double kMinLook = 0.1;
constexpr double kMinCorrelation = 0.9;

// Which of two values is nearer on a logarithmic scale.
bool nearer_to_first(double value, double first, double second) {
  return value * value < first * second ? first < second : second < first;
}

}  // namespace

void Histogram::add(double value) {
  const double bin = value / width_;
  if (bin >= 0.0 && bin < static_cast<double>(counts_.size())) {
    ++counts_[static_cast<std::size_t>(bin)];
    ++size_;
  }
}

double Histogram::median() const {
  std::size_t bin = 0;
  for (std::size_t below = counts_[0]; 2 * below < size_; below += counts_[bin]) {
    ++bin;
  }
  return (static_cast<double>(bin) + 0.5) * width_;
}

void TimecodeRate::add(const Timecode& timecode) {
  largest_ = std::max(largest_, timecode.frame);
  if (last_ && timecode.second == last_->second && timecode.frame > last_->frame) {
    steps_.add(timecode.frame - last_->frame);
  }
  if (last_ && timecode.second == last_->second + 1 && timecode.frame < last_->frame) {
    before_.add(last_->frame - timecode.frame);
  }
  last_ = timecode;
}

Guess<double> TimecodeRate::rate() const {
  const auto* const possible =
      std::find_if(kRates.begin(), kRates.end(), [this](double rate) { return largest_ < rate; });
  if (possible == kRates.end()) {
    return {kDefaultRate, false};
  }
  if (steps_.size() < kMinSteps || before_.size() == 0) {
    return {kDefaultRate, false};
  }
  const double measured = before_.median() + steps_.median();
  const auto* const best = std::min_element(possible, kRates.end(), [measured](double a, double b) {
    return std::abs(a - measured) < std::abs(b - measured);
  });
  return {*best, true};
}

void AngleUnit::Line::add(double x, const std::optional<double>& y) {
  if (y) {
    xx += x * x;
    xy += x * *y;
    yy += *y * *y;
    largest = std::max(largest, std::abs(x));
  }
}

void AngleUnit::add(const Rotations& rotations,
                    const std::array<double, formats::kControlCount>& controls) {
  for (std::size_t i = 0; i < formats::kRotationCount; ++i) {
    double& largest = i % 3 == 2 ? largest_roll_ : largest_;
    largest = std::max(largest, std::abs(rotations[i].value_or(0.0)));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (rotations[i] && last_[i] && *rotations[i] != *last_[i]) {
      steps_.add(std::abs(*rotations[i] - *last_[i]));
    }
  }
  last_ = rotations;
  const auto look = [&controls](std::size_t more, std::size_t less) {
    return formats::or_zero(controls[more]) - formats::or_zero(controls[less]);
  };
  eyes_[0].add(look(formats::control("eyeLookOutLeft"), formats::control("eyeLookInLeft")),
               rotations[3]);
  eyes_[1].add(look(formats::control("eyeLookUpLeft"), formats::control("eyeLookDownLeft")),
               rotations[4]);
  eyes_[2].add(look(formats::control("eyeLookInRight"), formats::control("eyeLookOutRight")),
               rotations[6]);
  eyes_[3].add(look(formats::control("eyeLookUpRight"), formats::control("eyeLookDownRight")),
               rotations[7]);
}

// The slope of the best fitting eye, in the file's unit.
std::optional<double> AngleUnit::eye_turn() const {
  double best = kMinCorrelation;
  std::optional<double> turn;
  for (const Line& line : eyes_) {
    const double correlation =
        line.xx > 0.0 && line.yy > 0.0 ? std::abs(line.xy) / std::sqrt(line.xx * line.yy) : 0.0;
    if (line.largest >= kMinLook && correlation >= best) {
      best = correlation;
      turn = std::abs(line.xy) / line.xx;
    }
  }
  return turn;
}

Guess<RotationUnit> AngleUnit::unit() const {
  const bool too_far = largest_ > kMaxAngle_rad || largest_roll_ > kHalfTurn * (1.0 + 1e-6);
  const bool too_fast = steps_.size() >= kMinHeadSteps && steps_.median() > kMaxStep_rad;
  if (too_far || too_fast) {
    return {RotationUnit::kDegrees, true};
  }
  const std::optional<double> turn = eye_turn();
  if (!turn) {
    return {RotationUnit::kRadians, false};
  }
  if (nearer_to_first(*turn, kEyeTurn_rad * 180.0 / std::numbers::pi, kEyeTurn_rad)) {
    return {RotationUnit::kDegrees, true};
  }
  const bool by_180 = nearer_to_first(*turn, kEyeTurn_rad / std::numbers::pi, kEyeTurn_rad) &&
                      std::max(largest_, largest_roll_) <= 1.0;
  return {by_180 ? RotationUnit::kDegreesBy180 : RotationUnit::kRadians, true};
}

}  // namespace mien::animation
