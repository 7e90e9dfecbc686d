// Fits crops to landmarks.
#include "tracker/geometry/crop.h"

#include <cmath>
#include <cstddef>

namespace mien::tracker {
namespace {

struct Mean {
  double x = 0.0;
  double y = 0.0;
};

Mean mean(std::span<const Point> points) {
  Mean sum;
  for (const Point& p : points) {
    sum.x += p.x;
    sum.y += p.y;
  }
  const double count = static_cast<double>(points.size());
  return {sum.x / count, sum.y / count};
}

}  // namespace

Affine crop_to_image(const Crop& crop) {
  const float c = crop.side * std::cos(crop.roll);
  const float s = crop.side * std::sin(crop.roll);
  return {c, -s, crop.center.x - 0.5f * (c - s), s, c, crop.center.y - 0.5f * (s + c)};
}

bool fit_crop(std::span<const Point> shape, std::span<const Point> landmarks, Crop& crop) {
  const Mean template_mean = mean(shape);
  const Mean landmark_mean = mean(landmarks);
  // With points as complex numbers, the similarity multiplies by sum(conj(t) p) / sum(|t|^2).
  double dot = 0.0;
  double cross = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const double tx = shape[i].x - template_mean.x;
    const double ty = shape[i].y - template_mean.y;
    const double px = landmarks[i].x - landmark_mean.x;
    const double py = landmarks[i].y - landmark_mean.y;
    dot += tx * px + ty * py;
    cross += tx * py - ty * px;
    spread += tx * tx + ty * ty;
  }
  const double c = dot / spread;
  const double s = cross / spread;
  const double cx = landmark_mean.x + c * (0.5 - template_mean.x) - s * (0.5 - template_mean.y);
  const double cy = landmark_mean.y + s * (0.5 - template_mean.x) + c * (0.5 - template_mean.y);
  const Crop fitted = {{static_cast<float>(cx), static_cast<float>(cy)},
                       static_cast<float>(std::hypot(c, s)),
                       static_cast<float>(std::atan2(s, c))};
  if (!is_finite(fitted.center) || !std::isfinite(fitted.side) || !(fitted.side > 1e-6f)) {
    return false;
  }
  crop = fitted;
  return true;
}

}  // namespace mien::tracker
