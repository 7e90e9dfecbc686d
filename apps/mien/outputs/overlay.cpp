// Draws landmarks, boxes, head axes and bars of controls.
#include "apps/mien/outputs/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace mien::app {
namespace {

constexpr int kPanelWidth = 240;
constexpr int kRowHeight = 9;
constexpr int kHeaderHeight = 24;
constexpr int kLabelWidth = 132;
constexpr Color kBackground{24, 26, 32};
constexpr Color kBar{90, 190, 120};
constexpr Color kBarBackground{48, 52, 62};
constexpr Color kInk{225, 228, 235};
constexpr Color kFaint{110, 115, 128};
constexpr Color kPoint{80, 255, 120};
constexpr Color kBox{255, 200, 60};

int min_height() { return kHeaderHeight + kRowHeight * mien_control_count() + 6; }

int scale_for(int height) { return std::max(1, min_height() * 4 / 5 / height); }

}  // namespace

Overlay::Overlay(int width, int height)
    : width_(width),
      height_(height),
      scale_(scale_for(height)),
      panel_x_(width * scale_),
      canvas_(width * scale_ + kPanelWidth, std::max(height * scale_, min_height())) {}

const Canvas& Overlay::draw(const mien_image& image, std::span<const Result> faces) {
  canvas_.fill(0, 0, canvas_.width(), canvas_.height(), kBackground);
  canvas_.paste(image, width_ * scale_, height_ * scale_);
  for (const Result& face : faces) {
    if (face.has_face()) {
      draw_face(face);
      draw_pose(face);
    }
  }
  draw_controls(faces.front());
  return canvas_;
}

void Overlay::draw_face(const Result& result) {
  const auto scale = static_cast<float>(scale_);
  const float x = result.box[0] * scale, y = result.box[1] * scale;
  const float right = x + result.box[2] * scale, bottom = y + result.box[3] * scale;
  canvas_.line(x, y, right, y, kBox);
  canvas_.line(right, y, right, bottom, kBox);
  canvas_.line(right, bottom, x, bottom, kBox);
  canvas_.line(x, bottom, x, y, kBox);
  const float radius = std::clamp(result.box[2] * scale / 200.0f, 1.0f, 2.5f);
  for (const auto& point : result.landmarks) {
    canvas_.dot(point[0] * scale, point[1] * scale, radius, kPoint);
  }
}

// Draws the head's axes from the centre of the box: x red, y green, z blue.
void Overlay::draw_pose(const Result& result) {
  const auto scale = static_cast<float>(scale_);
  const float qx = result.rotation[0], qy = result.rotation[1], qz = result.rotation[2],
              qw = result.rotation[3];
  const float axes[3][2] = {{1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw)},
                            {2 * (qx * qy - qz * qw), 1 - 2 * (qx * qx + qz * qz)},
                            {2 * (qx * qz + qy * qw), 2 * (qy * qz - qx * qw)}};
  const Color colors[3] = {{255, 80, 80}, {80, 255, 80}, {90, 140, 255}};
  const float x = (result.box[0] + result.box[2] / 2) * scale;
  const float y = (result.box[1] + result.box[3] / 2) * scale;
  const float length = result.box[2] * scale * 0.4f;
  for (int i = 0; i < 3; ++i) {
    canvas_.line(x, y, x + length * axes[i][0], y - length * axes[i][1], colors[i]);
  }
}

void Overlay::draw_controls(const Result& result) {
  char line[96];
  std::snprintf(line, sizeof line, "%s  p %.2f  lod %d", mien_face_status_name(result.status),
                static_cast<double>(result.face_probability), result.lod);
  canvas_.text(panel_x_ + 6, 4, line, kInk);
  constexpr double kDegrees = 57.29577951;
  std::snprintf(line, sizeof line, "pitch %+.0f yaw %+.0f roll %+.0f", result.pitch * kDegrees,
                result.yaw * kDegrees, result.roll * kDegrees);
  canvas_.text(panel_x_ + 6, 14, line, kFaint);
  constexpr int kBarWidth = kPanelWidth - kLabelWidth - 6;
  for (int i = 0; i < mien_control_count(); ++i) {
    const int y = kHeaderHeight + i * kRowHeight;
    const bool supported = result.supports(i);
    canvas_.text(panel_x_ + 6, y, mien_control_name(i), supported ? kInk : kFaint);
    if (supported) {
      canvas_.fill(panel_x_ + kLabelWidth, y, kBarWidth, kRowHeight - 2, kBarBackground);
      const float filled = std::clamp(result.controls[i], 0.0f, 1.0f) * kBarWidth;
      canvas_.fill(panel_x_ + kLabelWidth, y, static_cast<int>(filled), kRowHeight - 2, kBar);
    }
  }
}

}  // namespace mien::app
