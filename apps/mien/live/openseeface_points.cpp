// Maps landmarks to the 68 points of iBUG.
#include "apps/mien/live/openseeface_points.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace mien::app {
namespace {

// Indices of iBUG's 68 points among our landmarks: "ibug68" of models/landmarks.json.
constexpr std::array<std::size_t, 68> kIbug = {
    169, 167, 166, 164, 163, 162, 160, 158, 157, 156, 154, 152, 151, 150, 148, 147, 145,
    42,  43,  44,  45,  46,  51,  50,  49,  48,  47,  88,  90,  92,  93,  63,  62,  95,
    70,  71,  0,   20,  22,  8,   5,   3,   17,  29,  27,  9,   12,  14,  99,  102, 103,
    104, 105, 106, 109, 116, 115, 114, 113, 112, 119, 123, 124, 125, 129, 135, 134, 133};
constexpr std::array<std::size_t, 2> kPupils = {32, 37};  // right_iris_0, left_iris_0

// The mirrored counterpart of an iBUG point.
std::size_t partner(std::size_t point) {
  struct Group {
    std::size_t first, last, sum;  // the sum of the indices of both counterparts
  };
  constexpr Group kGroups[] = {{0, 16, 16},   {17, 26, 43},  {31, 35, 66}, {36, 39, 81},
                               {42, 45, 81},  {40, 41, 87},  {46, 47, 87}, {48, 54, 102},
                               {55, 59, 114}, {60, 64, 124}, {65, 67, 132}};
  for (const Group& group : kGroups) {
    if (point >= group.first && point <= group.last) {
      return group.sum - point;
    }
  }
  return point;  // the ridge of the nose
}

protocols::ImagePoint point_of(const Result& result, std::size_t landmark) {
  return {double{result.landmarks[landmark][0]}, double{result.landmarks[landmark][1]}};
}

}  // namespace

protocols::OpenSeeFaceImage openseeface_image(const Result& result, const mien_image& image,
                                              float fov_degrees) {
  protocols::OpenSeeFaceImage points;
  points.width = image.width;
  points.height = image.height;
  const double half_the_view = double{fov_degrees} / 2 * std::numbers::pi / 180;
  points.focal_length_px = points.width / 2 / std::tan(half_the_view);
  for (std::size_t i = 0; i < kIbug.size(); ++i) {
    points.landmarks[i] = point_of(result, kIbug[i]);
  }
  for (std::size_t i = 0; i < kPupils.size(); ++i) {
    points.pupils[i] = point_of(result, kPupils[i]);
  }
  return points;
}

protocols::OpenSeeFaceImage mirrored(const protocols::OpenSeeFaceImage& image) {
  const auto flipped = [&](const protocols::ImagePoint& point) {
    return protocols::ImagePoint{image.width - point[0], point[1]};
  };
  protocols::OpenSeeFaceImage result = image;
  for (std::size_t i = 0; i < image.landmarks.size(); ++i) {
    result.landmarks[partner(i)] = flipped(image.landmarks[i]);
  }
  result.pupils = {flipped(image.pupils[1]), flipped(image.pupils[0])};
  return result;
}

}  // namespace mien::app
