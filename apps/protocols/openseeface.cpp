// Computes 3D points and features of OpenSeeFace.
#include "apps/protocols/openseeface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "apps/animation/rotation.h"
#include "apps/protocols/bytes.h"

namespace mien::protocols {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows

constexpr double kMetresPerUnit = 0.14;  // the width of a face
constexpr std::size_t kPoints = 66;      // iBUG's points without the outer corners of the mouth
constexpr std::size_t kNoseTip = 30;

constexpr std::array<std::size_t, kPoints> kIbugPoints = [] {
  std::array<std::size_t, kPoints> points{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 68; ++i) {
    if (i != 48 && i != 54) {
      points[count++] = i;
    }
  }
  return points;
}();

// Distance of an average face's landmarks in front of the centre between its ears, metres.
constexpr std::array<double, kPoints> kDepths = {
    0.010, 0.012, 0.016, 0.024, 0.038, 0.056, 0.072, 0.084, 0.090,         // jaw, from the right
    0.084, 0.072, 0.056, 0.038, 0.024, 0.016, 0.012, 0.010,                //
    0.075, 0.086, 0.093, 0.097, 0.098, 0.098, 0.097, 0.093, 0.086, 0.075,  // brows
    0.096, 0.104, 0.112, 0.118, 0.096, 0.100, 0.104, 0.100, 0.096,         // nose
    0.070, 0.080, 0.083, 0.080, 0.082, 0.078,                              // right eye
    0.080, 0.083, 0.080, 0.070, 0.078, 0.082,                              // left eye
    0.098, 0.103, 0.104, 0.103, 0.098, 0.096, 0.101, 0.103, 0.101, 0.096,  // outer lips
    0.088, 0.098, 0.100, 0.098, 0.088, 0.098, 0.100, 0.098};               // inner lips
constexpr double kPupilDepth = 0.079;
// The centre of an eyeball behind its corners, relative to the distance between them.
constexpr double kEyeballDepth = 0.385;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Matrix matrix(const animation::Angles& angles) {
  const auto [x, y, z, w] = animation::quaternion(angles);
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

// The head in OpenSeeFace's spaces. Its model has x to the subject's right; its camera has x up, y
// to the left of the image, z towards the viewer. One of the two is left-handed. Its solver knows
// proper rotations only, so its result has an inverted depth, which receivers expect.
struct Head {
  Matrix rotation;      // head to mien's camera space
  Vector place;         // of the head in it, metres
  Matrix raw_rotation;  // of the model in OpenSeeFace's camera

  explicit Head(const animation::Frame& frame)
      : rotation(matrix(frame.head.value_or(animation::Angles()))),
        place(frame.position_m.value_or(Vector{})) {
    const auto& r = rotation;
    raw_rotation = {{{-r[1][0], r[1][1], r[1][2]},
                     {r[0][0], -r[0][1], -r[0][2]},
                     {r[2][0], -r[2][1], -r[2][2]}}};
  }

  [[nodiscard]] Vector to_head(const Vector& camera) const {
    const Vector from = {camera[0] - place[0], camera[1] - place[1], camera[2] - place[2]};
    Vector head{};
    for (std::size_t i = 0; i < 3; ++i) {
      head[i] = rotation[0][i] * from[0] + rotation[1][i] * from[1] + rotation[2][i] * from[2];
    }
    return head;
  }

  // The point on the ray through an image point that is at the given depth in front of the centre
  // of the head.
  [[nodiscard]] Vector on_face(const ImagePoint& point, const OpenSeeFaceImage& image,
                               double depth) const {
    const Vector ray = {(point[0] - image.width / 2) / image.focal_length_px,
                        (image.height / 2 - point[1]) / image.focal_length_px, -1.0};
    const Vector forward = {rotation[0][2], rotation[1][2], rotation[2][2]};
    constexpr double kMinSlant = 0.2;  // for faces in profile
    const double slant = dot(forward, ray);
    const double far =
        std::abs(slant) > kMinSlant ? (depth + dot(forward, place)) / slant : -place[2];
    return to_head({far * ray[0], far * ray[1], far * ray[2]});
  }
};

// Before the tip of the nose becomes the origin: right, up, out of the face.
std::vector<Vector> points_3d(const Head& head, const OpenSeeFaceImage& image) {
  std::vector<Vector> points;
  points.reserve(kPoints + 4);
  for (std::size_t i = 0; i < kPoints; ++i) {
    points.push_back(head.on_face(image.landmarks[kIbugPoints[i]], image, kDepths[i]));
  }
  for (const ImagePoint& pupil : image.pupils) {
    points.push_back(head.on_face(pupil, image, kPupilDepth));
  }
  for (const auto [outer, inner] : {std::array{36, 39}, std::array{45, 42}}) {
    const Vector& a = points[static_cast<std::size_t>(outer)];
    const Vector& b = points[static_cast<std::size_t>(inner)];
    const double apart = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    points.push_back(
        {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2 - kEyeballDepth * apart});
  }
  return points;
}

animation::Quaternion raw_quaternion(const Matrix& m) {
  // Of the four ways to convert a matrix to a quaternion, uses the one that divides by the largest
  // component. The result is that of the transposed matrix, as in OpenSeeFace.
  animation::Quaternion q;
  if (m[2][2] < 0) {
    q = m[0][0] > m[1][1]
            ? animation::Quaternion{1 + m[0][0] - m[1][1] - m[2][2], m[0][1] + m[1][0],
                                    m[2][0] + m[0][2], m[1][2] - m[2][1]}
            : animation::Quaternion{m[0][1] + m[1][0], 1 - m[0][0] + m[1][1] - m[2][2],
                                    m[1][2] + m[2][1], m[2][0] - m[0][2]};
  } else {
    q = m[0][0] < -m[1][1]
            ? animation::Quaternion{m[2][0] + m[0][2], m[1][2] + m[2][1],
                                    1 - m[0][0] - m[1][1] + m[2][2], m[0][1] - m[1][0]}
            : animation::Quaternion{m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0],
                                    1 + m[0][0] + m[1][1] + m[2][2]};
  }
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  for (double& part : q) {
    part /= length;
  }
  return q;
}

// R = Rz Ry Rx in degrees, x, y, z, as in OpenCV's RQDecomp3x3.
Vector raw_euler(const Matrix& m) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return {kDegrees * std::atan2(m[2][1], m[2][2]),
          kDegrees * std::atan2(-m[2][0], std::hypot(m[2][1], m[2][2])),
          kDegrees * std::atan2(m[1][0], m[0][0])};
}

// In OpenSeeFace's order: eyes, then for each side steepness, height and quirk of the brow, then
// height and width of each corner of the mouth, then the mouth.
std::array<double, 14> features(const animation::Frame& frame) {
  const auto value = [&](std::size_t which) { return formats::or_zero(frame.controls[which]); };
  const auto clamp_to_1 = [](double x) { return std::clamp(x, -1.0, 1.0); };
  struct Side {
    std::size_t blink, wide, brow_down, brow_outer, smile, frown, stretch;
  };
  const Side left = {formats::control("eyeBlinkLeft"),    formats::control("eyeWideLeft"),
                     formats::control("browDownLeft"),    formats::control("browOuterUpLeft"),
                     formats::control("mouthSmileLeft"),  formats::control("mouthFrownLeft"),
                     formats::control("mouthStretchLeft")};
  const Side right = {formats::control("eyeBlinkRight"),    formats::control("eyeWideRight"),
                      formats::control("browDownRight"),    formats::control("browOuterUpRight"),
                      formats::control("mouthSmileRight"),  formats::control("mouthFrownRight"),
                      formats::control("mouthStretchRight")};
  const double inner = value(formats::control("browInnerUp")),
               pucker = value(formats::control("mouthPucker"));
  const auto eye = [&](const Side& s) { return clamp_to_1(value(s.wide) - value(s.blink)); };
  const auto steep = [&](const Side& s) { return clamp_to_1(value(s.brow_down) - inner); };
  const auto height = [&](const Side& s) {
    return clamp_to_1((inner + value(s.brow_outer)) / 2 - value(s.brow_down));
  };
  const auto quirk = [&](const Side& s) { return clamp_to_1(value(s.brow_outer) - inner); };
  const auto corner = [&](const Side& s) { return clamp_to_1(value(s.smile) - value(s.frown)); };
  const auto out = [&](const Side& s) {
    return clamp_to_1(std::max(value(s.smile), value(s.stretch)) - pucker);
  };
  const double open = std::clamp(
      value(formats::control("jawOpen")) - value(formats::control("mouthClose")), 0.0, 1.0);
  return {eye(left),     eye(right),
          steep(left),   height(left),
          quirk(left),   steep(right),
          height(right), quirk(right),
          corner(left),  out(left),
          corner(right), out(right),
          open,          (out(left) + out(right)) / 2};
}

void append_floats(std::string& packet, std::span<const double> values) {
  for (const double value : values) {
    append_little_float(packet, value);
  }
}

}  // namespace

std::string openseeface_packet(const animation::Frame& frame, const OpenSeeFaceImage& image,
                               double unix_time_s) {
  const Head head(frame);
  std::vector<Vector> points = points_3d(head, image);
  const Vector nose = points[kNoseTip];
  std::string packet;
  append_little_double(packet, unix_time_s);
  append_little(packet, static_cast<std::uint32_t>(frame.face_id));
  append_floats(packet, std::array{image.width, image.height});
  append_floats(
      packet, std::array{1.0 - formats::or_zero(frame.controls[formats::control("eyeBlinkRight")]),
                         1.0 - formats::or_zero(frame.controls[formats::control("eyeBlinkLeft")])});
  append_little(packet, static_cast<std::uint8_t>(frame.head.has_value()));
  append_little_float(packet, 0.0);  // fit error of their model; there is no fit
  append_floats(packet, raw_quaternion(head.raw_rotation));
  append_floats(packet, raw_euler(head.raw_rotation));
  Vector tip = head.place;  // of the nose, in camera space
  for (std::size_t i = 0; i < 3; ++i) {
    tip[i] = (tip[i] + dot(head.rotation[i], nose)) / kMetresPerUnit;
  }
  append_floats(packet, std::array{tip[1], -tip[0], tip[2]});
  append_floats(packet, std::vector<double>(kPoints + 2, formats::or_zero(frame.face_probability)));
  for (const std::size_t i : kIbugPoints) {
    append_floats(packet, image.landmarks[i]);
  }
  for (const ImagePoint& pupil : image.pupils) {
    append_floats(packet, pupil);
  }
  for (const Vector& point : points) {  // their x is our negative x; they send -y and -z
    append_floats(packet, std::array{(nose[0] - point[0]) / kMetresPerUnit,
                                     (nose[1] - point[1]) / kMetresPerUnit,
                                     (nose[2] - point[2]) / kMetresPerUnit});
  }
  append_floats(packet, features(frame));
  return packet;
}

}  // namespace mien::protocols
