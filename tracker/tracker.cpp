#include "tracker/tracker.h"

#include <algorithm>
#include <cmath>

namespace mien::tracker {
namespace {

constexpr float kFadeSeconds = 0.25f;
constexpr float kFaded = 1e-4f;            // a control below is 0
constexpr int kAlignments = 2;             // of the crop to its landmarks when a face is acquired
constexpr std::size_t kJudged = 3;         // proposals shown to BaseNet on one frame
constexpr std::int32_t kEagerFrames = 30;  // searching on every one of them
constexpr float kSmallestFace = 0.02f;     // crop sides, in longer sides of the image
constexpr float kLargestFace = 4.0f;

// Whether a crop can still show something of a face in the image.
bool is_plausible(const Crop& crop, const ImageView& view) {
  const float longer = std::max(view.width, view.height);
  const float reach = crop.side / 2;
  const auto near = [reach](float value, float end) {
    return value >= -reach && value <= end + reach;
  };
  return crop.side >= kSmallestFace * longer && crop.side <= kLargestFace * longer &&
         near(crop.center.x, view.width) && near(crop.center.y, view.height);
}

}  // namespace

Tracker::Tracker(const mien_tracker_config& config, BaseNet& basenet, FaceProposal& proposal)
    : config_(config),
      basenet_(basenet),
      proposal_(proposal),
      timer_(config.clock_ns, config.clock_user) {}

void Tracker::reset() {
  state_ = State();
  state_.result.struct_size = sizeof state_.result;
  state_.result.lod = 1;
  state_.result.supported_controls = basenet_.supported_controls();
  basenet_.reset();
}

mien_status Tracker::push(const mien_image* image, std::int64_t pts_ns) {
  ImageView view;
  const mien_status status = view_image(image, config_.horizontal_fov, view);
  if (status != MIEN_OK) {
    return status;
  }
  timer_.clear();
  const Timeline::Step step = state_.timeline.advance(pts_ns);
  state_.result.flags = step.cut ? MIEN_RESULT_CUT : 0u;
  if (step.cut) {
    basenet_.reset();
  }
  state_.following = state_.following && state_.geometry == view;
  if (state_.following) {
    follow(view, step.cut);
  }
  if (!state_.following) {
    search(view);
  }
  if (state_.following) {
    animate(view);
  } else {
    fade(step.seconds);
  }
  publish(view, pts_ns);
  return MIEN_OK;
}

void Tracker::follow(const ImageView& view, bool cut) {
  if (state_.encoder_rests && !cut) {
    state_.encoder_rests = false;
    return;
  }
  Sight sight;
  if (look(view, state_.crop, sight) && sight.face_probability >= config_.lose_probability) {
    state_.following = accept(view, sight);
    return;
  }
  // Until the face counts as lost the decoders go on with what was last seen of it.
  ++state_.misses;
  state_.following = !cut && state_.misses < config_.lose_after_frames;
}

void Tracker::search(const ImageView& view) {
  ++state_.search_frames;
  if (!search_is_due()) {
    return;
  }
  std::array<Candidate, kJudged> candidates;
  std::size_t count = 0;
  {
    const StageTimer::Scope timed(timer_, MIEN_STAGE_PROPOSAL);
    count = proposal_.propose(view, candidates);
  }
  state_.result.flags |= MIEN_RESULT_PROPOSAL_RAN;
  ++state_.result.proposal_runs;
  if (count == 0) {
    state_.result.face_probability = 0.0f;
  }
  const auto found = std::span(candidates).first(count);
  state_.following = std::any_of(found.begin(), found.end(), [&](const Candidate& candidate) {
    return acquire(view, candidate.square);
  });
  if (state_.following) {
    state_.result.flags |= MIEN_RESULT_FOUND;
    state_.search_frames = 0;
    basenet_.reset();
  }
}

bool Tracker::search_is_due() const {
  const std::int32_t waited = state_.search_frames - kEagerFrames;
  return waited <= 0 || waited % config_.search_interval == 0;
}

bool Tracker::acquire(const ImageView& view, const Square& square) {
  Crop crop = {square.center, square.side, 0.0f};
  Sight sight;
  for (int i = 0; i <= kAlignments; ++i) {
    if (!is_plausible(crop, view) || !look(view, crop, sight)) {
      return false;
    }
    if (!basenet_.align(sight, crop)) {
      return false;
    }
  }
  return sight.face_probability >= config_.accept_probability && accept(view, sight);
}

bool Tracker::look(const ImageView& view, const Crop& crop, Sight& sight) {
  state_.result.flags |= MIEN_RESULT_ENCODER_RAN;
  ++state_.result.encoder_runs;
  const bool seen = basenet_.look(view, crop, timer_, sight);
  if (seen) {
    state_.result.face_probability = sight.face_probability;
  }
  return seen;
}

bool Tracker::accept(const ImageView& view, const Sight& sight) {
  Crop next;
  if (!basenet_.align(sight, next) || !is_plausible(next, view)) {
    return false;
  }
  state_.crop = next;
  state_.sight = sight;
  state_.misses = 0;
  state_.encoder_rests = true;
  return true;
}

void Tracker::animate(const ImageView& view) {
  const StageTimer::Scope timed(timer_, MIEN_STAGE_DECODERS);
  basenet_.decode_controls(state_.sight, state_.result.controls);
  basenet_.decode_pose(state_.sight, view.camera, state_.pose);
}

void Tracker::fade(float seconds) {
  const float factor = std::exp(-seconds / kFadeSeconds);
  for (float& control : state_.result.controls) {
    control = control > kFaded ? control * factor : 0.0f;
  }
}

void Tracker::publish(const ImageView& view, std::int64_t pts_ns) {
  mien_result& result = state_.result;
  result.pts_ns = pts_ns;
  ++result.frames;
  if (state_.following) {
    result.status = MIEN_FACE_TRACKING;
    ++result.face_frames;
    publish_face(view);
  } else if (result.status == MIEN_FACE_TRACKING) {
    result.status = MIEN_FACE_LOST;
  }
  for (int stage = 0; stage < MIEN_STAGE_COUNT; ++stage) {
    result.stage_ns[stage] = timer_.spent_ns(static_cast<mien_stage>(stage));
  }
  state_.geometry = view;
}

void Tracker::publish_face(const ImageView& view) {
  mien_result& result = state_.result;
  const Crop& crop = state_.crop;
  const Point center = to_picture(view, crop.center);
  result.box[0] = center.x - crop.side / 2;
  result.box[1] = center.y - crop.side / 2;
  result.box[2] = crop.side;
  result.box[3] = crop.side;
  for (std::size_t i = 0; i < state_.sight.landmarks.size(); ++i) {
    const Point p = to_picture(view, state_.sight.landmarks[i]);
    result.landmarks[i][0] = p.x;
    result.landmarks[i][1] = p.y;
  }
  const Quaternion q = quaternion(state_.pose.rotation);
  const std::array<float, 4> rotation = {q.x, q.y, q.z, q.w};
  std::copy(rotation.begin(), rotation.end(), result.rotation);
  const EulerAngles angles = euler_angles(state_.pose.rotation);
  result.pitch = angles.pitch;
  result.yaw = angles.yaw;
  result.roll = angles.roll;
  std::copy(state_.pose.translation.begin(), state_.pose.translation.end(), result.translation);
}

}  // namespace mien::tracker
