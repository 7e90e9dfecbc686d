#include "tracker/tracker.h"

#include <algorithm>
#include <array>

namespace mien::tracker {
namespace {

constexpr std::size_t kJudged = 3;         // proposals shown to BaseNet on one frame
constexpr std::int32_t kEagerFrames = 30;  // searching on every one of them

std::int32_t highest_level(const mien_tracker_config& config) {
  return config.hifinet != nullptr ? kHighestLevel : kLowestLevel;
}

}  // namespace

Tracker::Tracker(const mien_tracker_config& config, Encoders& encoders, FaceProposal& proposal)
    : config_(config),
      proposal_(proposal),
      timer_(config.clock_ns, config.clock_user),
      lod_(config.lod),
      governor_(config.budget_ms, highest_level(config)),
      face_(config_, encoders) {}

void Tracker::reset() {
  governor_ = LevelGovernor(config_.budget_ms, highest_level(config_));
  lod_ = config_.lod;
  state_ = State();
  state_.result.struct_size = sizeof state_.result;
  state_.result.lod = level();
  state_.result.supported_controls = face_.supported_controls(level());
  face_.reset(level());
}

bool Tracker::set_level(std::int32_t lod) {
  if (lod < 0 || lod > highest_level(config_)) {
    return false;
  }
  lod_ = lod;
  return true;
}

mien_status Tracker::push(const mien_image* image, std::int64_t pts_ns) {
  ImageView view;
  const mien_status status = view_image(image, config_.horizontal_fov, view);
  if (status != MIEN_OK) {
    return status;
  }
  timer_.clear();
  const Timeline::Step step = state_.timeline.advance(pts_ns);
  Frame frame = {view, timer_, level(), step.seconds, step.cut};
  if (step.cut) {
    frame.flags |= MIEN_RESULT_CUT;
    face_.cut(frame.level);
  }
  if (face_.is_followed() && !(state_.geometry == view)) {
    face_.lose();
  }
  const bool followed = face_.is_followed();
  if (followed) {
    face_.follow(frame);
  }
  if (!face_.is_followed()) {
    search(frame);
  }
  face_.animate(frame);
  publish(frame, pts_ns);
  if (followed && face_.is_followed()) {
    governor_.account(timer_.total_ns(), step.seconds);
  }
  return MIEN_OK;
}

void Tracker::search(Frame& frame) {
  ++state_.search_frames;
  if (!search_is_due()) {
    return;
  }
  std::array<Candidate, kJudged> candidates;
  std::size_t count = 0;
  {
    const StageTimer::Scope timed(timer_, MIEN_STAGE_PROPOSAL);
    count = proposal_.propose(frame.view, candidates);
  }
  frame.flags |= MIEN_RESULT_PROPOSAL_RAN;
  ++state_.result.proposal_runs;
  if (count == 0) {
    frame.face_probability = 0.0f;
  }
  const auto found = std::span(candidates).first(count);
  const bool acquired = std::any_of(found.begin(), found.end(), [&](const Candidate& candidate) {
    return face_.acquire(frame, candidate.square);
  });
  if (acquired) {
    state_.search_frames = 0;
  }
}

bool Tracker::search_is_due() const {
  const std::int32_t waited = state_.search_frames - kEagerFrames;
  return waited <= 0 || waited % config_.search_interval == 0;
}

void Tracker::publish(const Frame& frame, std::int64_t pts_ns) {
  mien_result& result = state_.result;
  result.pts_ns = pts_ns;
  result.flags = frame.flags;
  result.lod = frame.level;
  result.supported_controls = face_.supported_controls(frame.level);
  if (frame.face_probability >= 0.0f) {
    result.face_probability = frame.face_probability;
  }
  ++result.frames;
  result.face_frames += face_.is_followed() ? 1 : 0;
  result.encoder_runs += frame.encoder_runs;
  face_.publish(frame.view, result);
  for (int stage = 0; stage < MIEN_STAGE_COUNT; ++stage) {
    result.stage_ns[stage] = timer_.spent_ns(static_cast<mien_stage>(stage));
  }
  state_.geometry = frame.view;
}

}  // namespace mien::tracker
