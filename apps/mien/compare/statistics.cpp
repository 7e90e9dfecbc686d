// Computes differences, correlation and jitter of matched frames.
#include "apps/mien/compare/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mien::app {
namespace {

// Smaller deviations are rounding errors of a constant curve.
constexpr double kMinSpread = 1e-9;

int sign(double value) { return (value > 0.0) - (value < 0.0); }

// One control of both files; NaN in both if either file lacks a value.
struct Series {
  std::vector<double> a, b, t_ms;
};

Series series_of(std::size_t control, const Curves& a, const Curves& b,
                 const std::vector<FramePair>& pairs) {
  Series series;
  for (const FramePair& pair : pairs) {
    const double value_a = a[pair.a].controls[control];
    const double value_b = b[pair.b].controls[control];
    const bool both = !std::isnan(value_a) && !std::isnan(value_b);
    series.a.push_back(both ? value_a : std::nan(""));
    series.b.push_back(both ? value_b : std::nan(""));
    series.t_ms.push_back(a[pair.a].t_ms);
  }
  return series;
}

void note(Extreme& extreme, double value, double t_ms) {
  if (value > extreme.value) {
    extreme = {value, t_ms};
  }
}

std::optional<double> correlation(const Series& series, const Difference& of) {
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    if (std::isnan(series.a[i])) {
      continue;
    }
    const double a = series.a[i] - of.mean_a, b = series.b[i] - of.mean_b;
    aa += a * a;
    bb += b * b;
    ab += a * b;
  }
  const double spread = std::sqrt(aa * bb);
  if (spread <= kMinSpread * static_cast<double>(of.frames)) {
    return std::nullopt;
  }
  return ab / spread;
}

Difference compare(const Series& series) {
  Difference d;
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    if (std::isnan(series.a[i])) {
      continue;
    }
    const double apart = std::abs(series.a[i] - series.b[i]);
    ++d.frames;
    d.mean_abs += apart;
    d.mean_a += series.a[i];
    d.mean_b += series.b[i];
    note(d.max_abs, apart, series.t_ms[i]);
  }
  if (d.frames == 0) {
    return d;
  }
  const auto frames = static_cast<double>(d.frames);
  d.mean_abs /= frames;
  d.mean_a /= frames;
  d.mean_b /= frames;
  d.correlation = correlation(series, d);
  d.jitter_a = jitter(series.a);
  d.jitter_b = jitter(series.b);
  return d;
}

void summarize(Differences& differences) {
  Difference& all = differences.all;
  double correlations = 0.0, correlated = 0.0;
  for (std::size_t i = 0; i < differences.controls.size(); ++i) {
    const Difference& control = differences.controls[i];
    const auto frames = static_cast<double>(control.frames);
    all.frames += control.frames;
    all.mean_abs += control.mean_abs * frames;
    all.mean_a += control.mean_a * frames;
    all.mean_b += control.mean_b * frames;
    all.jitter_a += control.jitter_a * frames;
    all.jitter_b += control.jitter_b * frames;
    if (control.max_abs.value > all.max_abs.value) {
      all.max_abs = control.max_abs;
      differences.max_abs_control = i;
    }
    if (control.correlation) {
      correlations += *control.correlation;
      correlated += 1.0;
    }
  }
  const double cells = std::max(1.0, static_cast<double>(all.frames));
  for (double* sum : {&all.mean_abs, &all.mean_a, &all.mean_b, &all.jitter_a, &all.jitter_b}) {
    *sum /= cells;
  }
  if (correlated > 0.0) {
    all.correlation = correlations / correlated;
  }
}

struct Quaternion {
  double x, y, z, w;
};

Quaternion operator*(const Quaternion& p, const Quaternion& q) {
  return {
      p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
      p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z};
}

Quaternion rotation(const HeadAngles& head) {
  const Quaternion yaw{0.0, std::sin(head.yaw / 2.0), 0.0, std::cos(head.yaw / 2.0)};
  const Quaternion pitch{std::sin(head.pitch / 2.0), 0.0, 0.0, std::cos(head.pitch / 2.0)};
  const Quaternion roll{0.0, 0.0, std::sin(head.roll / 2.0), std::cos(head.roll / 2.0)};
  return yaw * pitch * roll;
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

// The smaller of both angles between two rotations.
double apart_deg(double a, double b) {
  return degrees(std::abs(std::remainder(a - b, 2.0 * std::numbers::pi)));
}

double rotation_apart_deg(const HeadAngles& a, const HeadAngles& b) {
  const Quaternion p = rotation(a), q = rotation(b);
  const Quaternion between = p * Quaternion{-q.x, -q.y, -q.z, q.w};
  return degrees(2.0 *
                 std::atan2(std::hypot(between.x, between.y, between.z), std::abs(between.w)));
}

void add(AngleDifference& angle, double apart, double t_ms) {
  angle.mean_abs_deg += apart;
  note(angle.max_abs_deg, apart, t_ms);
}

HeadDifference compare_heads(const Curves& a, const Curves& b,
                             const std::vector<FramePair>& pairs) {
  HeadDifference d;
  for (const FramePair& pair : pairs) {
    const auto &head_a = a[pair.a].head, &head_b = b[pair.b].head;
    if (!head_a || !head_b) {
      continue;
    }
    const double t_ms = a[pair.a].t_ms;
    ++d.frames;
    add(d.pitch, apart_deg(head_a->pitch, head_b->pitch), t_ms);
    add(d.yaw, apart_deg(head_a->yaw, head_b->yaw), t_ms);
    add(d.roll, apart_deg(head_a->roll, head_b->roll), t_ms);
    add(d.rotation, rotation_apart_deg(*head_a, *head_b), t_ms);
  }
  for (AngleDifference* angle : {&d.pitch, &d.yaw, &d.roll, &d.rotation}) {
    angle->mean_abs_deg /= std::max(1.0, static_cast<double>(d.frames));
  }
  return d;
}

}  // namespace

double jitter(const std::vector<double>& values) {
  double sum = 0.0, frames = 0.0;
  double step = std::nan(""), last = std::nan("");
  for (const double value : values) {
    const double next_step = value - last;  // NaN after a gap
    if (!std::isnan(next_step) && !std::isnan(step) && sign(next_step) != sign(step)) {
      sum += std::abs(next_step);
    }
    step = next_step;
    last = value;
    frames += std::isnan(value) ? 0.0 : 1.0;
  }
  return frames > 0.0 ? sum / frames : 0.0;
}

Differences differences(const Curves& a, const Curves& b, const std::vector<FramePair>& pairs) {
  Differences found;
  found.matched_frames = pairs.size();
  for (std::size_t i = 0; i < found.controls.size(); ++i) {
    found.controls[i] = compare(series_of(i, a, b, pairs));
  }
  summarize(found);
  found.head = compare_heads(a, b, pairs);
  return found;
}

}  // namespace mien::app
