// Tracks one face: crops, encodes and decodes each frame.
#include "tracker/faces/face.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tracker/decoders/smoothing.h"
#include "tracker/encoders/levels.h"

namespace mien::tracker {
namespace {

constexpr float kFadeSeconds = 0.25f;
constexpr float kPresenceSeconds = 0.1f;
constexpr float kFaded = 1e-4f;  // smaller controls become 0
// Limits of a crop's side, relative to the longer side of the image.
constexpr float kMinFace = 0.02f;
constexpr float kMaxFace = 4.0f;
// Weight of HiFiNet's landmarks in the mean with BaseNet's. On validation portraits the mean has an
// error of 3.24 %, HiFiNet alone 3.31 %.
constexpr float kHiFiNetWeight = 0.8f;
constexpr float kDetectorScoreWeight = 0.4f;  // relative to the face probability's
// Added to the log-odds required of a detection at a roll other than 0: detection tries several
// rolls at each place, which multiplies its false positives.
constexpr float kRolledMargin = 0.5f;

// Whether a crop can contain a part of a face in the image.
bool is_plausible(const Crop& crop, const ImageView& view) {
  const Rect& visible = view.region;
  const float longer = visible.longer_side();
  const float reach = crop.side / 2;
  const auto near = [reach](float value, float begin, float length) {
    return value >= begin - reach && value <= begin + length + reach;
  };
  return crop.side >= kMinFace * longer && crop.side <= kMaxFace * longer &&
         near(crop.center.x, visible.corner.x, visible.width) &&
         near(crop.center.y, visible.corner.y, visible.height);
}

float log_odds(float probability) {
  constexpr float kSure = 1e-6f;
  const float p = std::clamp(probability, kSure, 1.0f - kSure);
  return std::log(p / (1.0f - p));
}

// The probability from face probability and detector score, whose errors are independent.
float combined(float face_probability, const Detection& detection) {
  const float margin = detection.roll == 0.0f ? 0.0f : kRolledMargin;
  return 1.0f / (1.0f + std::exp(margin - log_odds(face_probability) -
                                 kDetectorScoreWeight * log_odds(detection.score)));
}

}  // namespace

void Face::reset(std::int32_t level) {
  state_ = State();
  decoders_.reset(level);
  for (const std::int32_t either : {kMinLevel, kMaxLevel}) {
    decoders_.neutral(either).forget();
  }
  mien_result_default(&result_);
}

bool Face::find(Frame& frame, const Detection& detection, int alignments, Encoding& encoding) {
  Crop crop = {detection.square.center, detection.square.side, detection.roll};
  for (int i = 0; i <= alignments; ++i) {
    if (!is_plausible(crop, frame.view) || !encode(frame, crop, encoding)) {
      return false;
    }
    if (!encoders_.basenet.align(encoding, crop)) {
      return false;
    }
  }
  return encoding.face_probability >= config_.lose_probability &&
         combined(encoding.face_probability, detection) >= config_.accept_probability;
}

bool Face::start_tracking(Frame& frame, const Encoding& encoding, std::uint32_t id) {
  if (!accept(frame, encoding)) {
    return false;
  }
  if (frame.level > kMinLevel) {
    encode_hifinet(frame);
  }
  state_.id = id;
  state_.tracked = true;
  state_.is_new = true;
  state_.alternate = true;
  decoders_.reset(frame.level);
  state_.flags |= MIEN_RESULT_FOUND;
  return true;
}

void Face::change_geometry(const ImageGeometry& before, const ImageGeometry& now) {
  state_.tracked = false;
  if (!is_known()) {
    return;
  }
  Crop& crop = state_.crop;
  crop.center.x *= now.width / before.width;
  crop.center.y *= now.height / before.height;
  crop.side *= std::max(now.width, now.height) / std::max(before.width, before.height);
}

void Face::track(Frame& frame) {
  state_.has_hifinet_features = state_.has_hifinet_features && frame.level > kMinLevel;
  const bool may_rest = frame.level == kMinLevel || state_.has_hifinet_features;
  const bool alternate = state_.alternate && may_rest && !frame.cut;
  const EncoderWork work = encoder_work(frame.level, alternate);
  state_.alternate = false;
  if (!work.basenet) {
    return;
  }
  Encoding encoding;
  if (encode(frame, state_.crop, encoding) &&
      encoding.face_probability >= config_.lose_probability) {
    state_.tracked = accept(frame, encoding);
    state_.alternate = !alternate;
    if (state_.tracked && work.hifinet) {
      encode_hifinet(frame);
    }
    return;
  }
  mark_missed(frame);
}

// Until the face is lost, the decoders continue with its latest features. The next image is
// encoded, because misses must be consecutive.
void Face::mark_missed(const Frame& frame) {
  state_.alternate = false;
  ++state_.misses;
  state_.tracked = !frame.cut && state_.misses < config_.lose_after_frames;
}

bool Face::encode(Frame& frame, const Crop& crop, Encoding& encoding) {
  state_.flags |= MIEN_RESULT_ENCODER_RAN;
  ++frame.encoder_runs;
  const bool encoded = encoders_.basenet.encode(frame.view, crop, frame.timer, encoding);
  if (encoded) {
    state_.face_probability = encoding.face_probability;
  }
  return encoded;
}

bool Face::accept(const Frame& frame, const Encoding& encoding) {
  Crop next;
  if (!encoders_.basenet.align(encoding, next) || !is_plausible(next, frame.view)) {
    return false;
  }
  state_.crop = next;
  state_.encoding = encoding;
  state_.misses = 0;
  return true;
}

void Face::encode_hifinet(Frame& frame) {
  ++frame.encoder_runs;
  Encoding encoding;
  if (!encoders_.hifinet.encode(frame.view, state_.crop, frame.timer, encoding)) {
    return;
  }
  state_.has_hifinet_features = true;
  state_.hifinet_features = encoding.features;
  const float scale = kHiFiNetWeight / state_.crop.side;
  std::transform(encoding.landmarks.begin(), encoding.landmarks.end(),
                 state_.encoding.landmarks.begin(), state_.refinement.begin(),
                 [scale](Point fine, Point coarse) {
                   return Point{scale * (fine.x - coarse.x), scale * (fine.y - coarse.y)};
                 });
}

// The weighted mean of both networks' landmarks; on frames without HiFiNet, BaseNet's with the
// latest refinement.
Landmarks Face::landmarks(std::int32_t level) const {
  Landmarks refined = state_.encoding.landmarks;
  if (level == kMinLevel) {
    return refined;
  }
  const float side = state_.crop.side;
  std::transform(refined.begin(), refined.end(), state_.refinement.begin(), refined.begin(),
                 [side](Point whole, Point refinement) {
                   return Point{whole.x + side * refinement.x, whole.y + side * refinement.y};
                 });
  return refined;
}

void Face::animate(Frame& frame) {
  const float alpha = 1.0f - std::exp(-frame.seconds / kPresenceSeconds);
  state_.presence += alpha * ((state_.tracked ? 1.0f : 0.0f) - state_.presence);
  if (!state_.tracked) {
    fade(frame.seconds);
    state_.seconds_lost += frame.seconds;
    if (state_.status == MIEN_FACE_TRACKING) {
      state_.status = MIEN_FACE_LOST;
    }
    return;
  }
  state_.status = MIEN_FACE_TRACKING;
  state_.seconds_lost = 0.0f;
  const StageTimer::Scope timed(frame.timer, MIEN_STAGE_DECODERS);
  FaceOutput& raw = state_.raw;
  decoders_.decode_controls(state_.encoding.features, state_.hifinet_features, frame.level,
                            frame.seconds, raw.controls);
  state_.flags |=
      decoders_.neutral(frame.level).is_being_captured() ? MIEN_RESULT_CAPTURING_NEUTRAL : 0;
  decoders_.decode_pose(state_.encoding.features, state_.encoding.crop, frame.view.camera,
                        raw.pose);
  refine_head_pose(encoders_.basenet.head_points(), state_.encoding.landmarks, frame.view.camera,
                   raw.pose);
  raw.landmarks = landmarks(frame.level);
  state_.is_new = state_.is_new || frame.cut;
  smooth(frame.seconds);
}

void Face::smooth(float seconds) {
  if (config_.smoothing == 0 || state_.is_new) {
    state_.smoothed = state_.raw;
    state_.is_new = false;
    return;
  }
  smooth_controls(state_.raw.controls, seconds, state_.smoothed.controls);
  smooth_points(state_.raw.landmarks, state_.crop.side, seconds, state_.smoothed.landmarks);
  smooth_pose(state_.raw.pose, seconds, state_.smoothed.pose);
}

void Face::fade(float seconds) {
  const float factor = std::exp(-seconds / kFadeSeconds);
  for (float& control : state_.smoothed.controls) {
    control = control > kFaded ? control * factor : 0.0f;
  }
}

std::array<float, kControls> Face::video_weights() const {
  std::array<float, kControls> weights;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = state_.presence * decoders_.supported_weight(i);
  }
  return weights;
}

void Face::publish(const Frame& frame) {
  const ImageView& view = frame.view;
  mien_result& result = result_;
  result.status = state_.status;
  result.face_id = state_.id;
  result.flags |= std::exchange(state_.flags, 0);
  result.face_probability = state_.face_probability;
  result.supported_controls = supported_controls(frame.level);
  const FaceOutput& output = state_.smoothed;
  for (std::size_t i = 0; i < output.controls.size(); ++i) {
    const bool driven = (result.supported_controls >> i & 1u) != 0;
    result.controls[i] = driven ? output.controls[i] : 0.0f;  // smoothing does not reach 0 exactly
  }
  if (!state_.tracked) {
    return;
  }
  const Crop& crop = state_.crop;
  const Point center = to_upright(view, crop.center);
  result.box[0] = center.x - crop.side / 2;
  result.box[1] = center.y - crop.side / 2;
  result.box[2] = crop.side;
  result.box[3] = crop.side;
  for (std::size_t i = 0; i < output.landmarks.size(); ++i) {
    const Point p = to_upright(view, output.landmarks[i]);
    result.landmarks[i][0] = p.x;
    result.landmarks[i][1] = p.y;
  }
  const Quaternion q = quaternion(output.pose.rotation);
  const std::array<float, 4> rotation = {q.x, q.y, q.z, q.w};
  std::copy(rotation.begin(), rotation.end(), result.rotation);
  const EulerAngles angles = euler_angles(output.pose.rotation);
  result.pitch = angles.pitch;
  result.yaw = angles.yaw;
  result.roll = angles.roll;
  std::copy(output.pose.translation.begin(), output.pose.translation.end(), result.translation);
}

}  // namespace mien::tracker
