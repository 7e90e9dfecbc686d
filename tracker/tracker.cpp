// Runs the stages of a frame: image, audio, faces and results.
#include "tracker/tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace mien::tracker {
namespace {

constexpr std::size_t kRefined = 4;        // detections of a coarse search or tile, by R-Net
constexpr std::size_t kVerified = 2;       // of these, by BaseNet
constexpr std::int32_t kEagerFrames = 30;  // first frames without a face: no pause in detection
// Alignments of a detection before it is verified. A new scene has time for more: on 1,401
// portraits they lose 15 instead of 24 faces, with as many false ones.
constexpr int kAlignments = 2;
constexpr int kAlignmentsInNewScene = 4;

// Steps without a face, in order: both chunks of a coarse search, then some chunks of a scan.
enum Step : std::uint32_t { kBeginCoarse, kEndCoarse, kScan };

// The amount of detection per frame.
struct Pace {
  std::uint64_t steps;   // per two frames
  std::uint32_t chunks;  // of a scan, after each coarse search
  bool begins_at_loss;   // on the frame that loses the face, else one frame later
};
constexpr Pace kPace = {8, 2, true};
constexpr Pace kPaceOfMinLevel = {3, 1,
                                  false};  // frames are cheap, so their cost should vary little

// Rolls of detection besides 0, in radians; it finds faces within about 30 degrees of each.
constexpr float kEighthTurn = 0.78539816f;
constexpr std::array<float, 7> kRolls = {2 * kEighthTurn, -2 * kEighthTurn, kEighthTurn,
                                         -kEighthTurn,    3 * kEighthTurn,  -3 * kEighthTurn,
                                         4 * kEighthTurn};

Pace pace_at(std::int32_t level) { return level == kMinLevel ? kPaceOfMinLevel : kPace; }

}  // namespace

Tracker::Tracker(const mien_tracker_config& config, Encoders& encoders, FaceDetector& proposal)
    : config_(config),
      encoders_(encoders),
      proposal_(proposal),
      timer_(config.clock_ns, config.clock_user),
      lod_(config.lod),
      governor_(config.budget_ms, config.max_lod) {}

mien_status Tracker::load(const Models& models, engine::Arena& arena) {
  const mien_status status = faces_.load(config_, encoders_, models, arena);
  return status == MIEN_OK && models.has_audionet ? AudioTrack::load(models, config_, arena, audio_)
                                                  : status;
}

void Tracker::reset() {
  governor_ = LevelGovernor(config_.budget_ms, config_.max_lod);
  lod_ = config_.lod;
  state_ = State();
  faces_.reset(level());
  for (Face& face : faces_.all()) {
    face.result().lod = level();
    face.result().supported_controls = face.supported_controls(level());
  }
  if (audio_ != nullptr) {
    audio_->reset();
  }
  timer_.clear();
}

bool Tracker::set_level(std::int32_t lod) {
  if (lod < 0 || lod > config_.max_lod) {
    return false;
  }
  if (lod == 0 && lod_ != 0) {
    governor_.begin_at(lod_);
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
  const Timeline::Step step = state_.timeline.advance(pts_ns);
  Frame frame = {view, timer_, level(), step.seconds, step.cut};
  // The first image may be the only one, and may take longer.
  const bool new_scene = std::exchange(state_.cut_without_image, false) || frame.cut ||
                         !(state_.view == static_cast<const ImageGeometry&>(view));
  if (new_scene) {
    state_.search = Search();
  }
  const bool tracked = faces_.tracked() > 0;
  track(frame);
  const bool begins = !tracked || new_scene || pace_at(frame.level).begins_at_loss;
  const bool due = begins && faces_.tracked() == 0 && (detection_is_due() || new_scene);
  const bool searched = due || state_.search.is_running();
  if (searched && new_scene) {
    search_all_rolls(frame);
  } else if (searched) {
    search(frame);
  } else if (faces_.tracked() > 0 && faces_.has_free_slot()) {
    detect_in_tile(frame);
  }
  state_.view = view;
  finish(frame, pts_ns, searched ? MIEN_RESULT_PROPOSAL_RAN : 0u);
  if (tracked && !searched && faces_.tracked() > 0) {
    governor_.account(timer_.total_ns(), step.seconds);
  }
  timer_.clear();
  return MIEN_OK;
}

void Tracker::advance(std::int64_t pts_ns) {
  const Timeline::Step step = state_.timeline.advance(pts_ns);
  Frame frame = {state_.view, timer_, level(), step.seconds, step.cut};
  if (frame.cut) {
    state_.search = Search();
    state_.cut_without_image = true;
  }
  for (Face& face : faces_.all()) {
    if (frame.cut) {
      face.cut(frame.level);
    }
    if (face.is_tracked()) {
      face.mark_missed(frame);
    }
  }
  finish(frame, pts_ns, 0u);
  timer_.clear();
}

mien_status Tracker::push_audio(const mien_audio* sound, std::int64_t pts_ns) {
  if (audio_ == nullptr) {
    return MIEN_ERROR_NO_AUDIONET;
  }
  const StageTimer::Scope timed(timer_, MIEN_STAGE_SOUND);
  return audio_->push(sound, pts_ns);
}

void Tracker::finish(Frame& frame, std::int64_t pts_ns, std::uint32_t flags) {
  for (Face& face : faces_.all()) {
    face.animate(frame);
  }
  faces_.forget_lost(frame.level);
  if (audio_ != nullptr) {
    if (audio_->has_queued()) {
      const StageTimer::Scope timed(timer_, MIEN_STAGE_SOUND);
      audio_->process_queued();
    }
    audio_->advance(pts_ns, frame.seconds);
  }
  publish(frame, pts_ns, flags | (frame.cut ? MIEN_RESULT_CUT : 0u));
}

void Tracker::track(Frame& frame) {
  const ImageGeometry& before = state_.view;
  for (Face& face : faces_.all()) {
    if (frame.cut) {
      face.cut(frame.level);
    }
    if (!(before == frame.view)) {
      face.change_geometry(before, frame.view);
    }
    if (face.is_tracked()) {
      face.track(frame);
    }
  }
  faces_.drop_duplicates(frame.level);
}

void Tracker::search_all_rolls(Frame& frame) {
  ++state_.proposal_runs;
  for (std::size_t i = 0; i <= kRolls.size() && faces_.tracked() == 0; ++i) {
    begin_scan(frame, i == 0, i == 0 ? 0.0f : kRolls[i - 1]);
    while (scan(frame)) {
    }
    while (state_.search.has_unverified()) {
      verify_next(frame, kAlignmentsInNewScene);
    }
  }
}

void Tracker::search(Frame& frame) {
  std::uint64_t steps = (pace_at(frame.level).steps + state_.frames % 2) / 2;
  do {
    search_step(frame);
  } while (--steps > 0 && state_.search.is_running());
}

void Tracker::search_step(Frame& frame) {
  Search& search = state_.search;
  if (search.has_unverified()) {
    verify_next(frame, kAlignments);
    return;
  }
  const std::uint32_t step = search.step;
  search.step = step + 1 < kScan + pace_at(frame.level).chunks ? step + 1 : kBeginCoarse;
  if (step == kBeginCoarse) {
    begin_coarse(frame);
  } else if (step == kEndCoarse) {
    end_coarse(frame);
  } else {
    if (!search.is_scanning) {
      // A thorough scan finds faces that others miss, but takes longer.
      const float roll = next_roll();
      begin_scan(frame, state_.searches % 4 == 0 && roll == 0.0f, roll);
      ++state_.searches;
      ++state_.proposal_runs;
    }
    scan(frame);
  }
}

void Tracker::begin_scan(Frame& frame, bool thorough, float roll) {
  state_.search.is_scanning = true;
  proposal_.begin(frame.view, thorough, roll);
}

bool Tracker::scan(Frame& frame) {
  const StageTimer::Scope timed(frame.timer, MIEN_STAGE_PROPOSAL);
  Search& search = state_.search;
  search.is_scanning = proposal_.run_next_chunk(frame.view);
  if (!search.is_scanning) {
    search.verified = 0;
    search.count = proposal_.found(
        std::span(search.detected).first(kMaxVerified - MIEN_MAX_FACES + faces_.all().size()));
    if (search.count == 0) {
      std::for_each(faces_.all().begin(), faces_.all().end(),
                    [](Face& face) { face.mark_absent(); });
    }
  }
  return search.is_scanning;
}

void Tracker::begin_coarse(Frame& frame) {
  const StageTimer::Scope timed(frame.timer, MIEN_STAGE_PROPOSAL);
  proposal_.begin_coarse(frame.view, next_coarse_roll());
  ++state_.coarse_searches;
}

void Tracker::end_coarse(Frame& frame) {
  const StageTimer::Scope timed(frame.timer, MIEN_STAGE_PROPOSAL);
  Search& search = state_.search;
  const std::size_t count =
      proposal_.end_coarse(frame.view, std::span(search.detected).first(kRefined));
  search.verified = 0;
  search.count = std::min(count, kVerified);
}

// The first scan after a loss uses the roll of the lost face. Of every four scans, two are upright.
float Tracker::next_roll() const {
  const std::uint32_t n = state_.searches;
  if (n == 0) {
    return lost_roll();
  }
  return n % 4 < 2 ? 0.0f : kRolls[(n / 4 * 2 + n % 2) % kRolls.size()];
}

// The first coarse search after a loss uses the roll of the lost face. Passes alternate between
// kRolls and the rolls halfway between their neighbors; each begins upright.
float Tracker::next_coarse_roll() const {
  constexpr std::uint32_t kFirstPass = 1 + kRolls.size(), kSecondPass = kFirstPass + 1;
  const std::uint32_t n = state_.coarse_searches, i = n % (kFirstPass + kSecondPass);
  if (i == 0 || i == kFirstPass) {
    return n == 0 ? lost_roll() : 0.0f;
  }
  if (i < kFirstPass) {
    return kRolls[i - 1];
  }
  return kEighthTurn / 2 + (i == kFirstPass + 1 ? 0.0f : kRolls[i - kFirstPass - 2]);
}

float Tracker::lost_roll() const {
  const float roll = faces_.first().is_known() ? faces_.first().roll() : 0.0f;
  return std::abs(roll) > kEighthTurn / 2 ? roll : 0.0f;
}

void Tracker::verify_next(Frame& frame, int alignments) {
  Search& search = state_.search;
  const bool added = faces_.add_face(frame, search.detected[search.verified++], alignments);
  if (added) {
    state_.frames_without_face = 0;
    state_.searches = 0;
    state_.coarse_searches = 0;
    search.is_scanning = false;
    search.step = 0;
  }
  if (!faces_.has_free_slot()) {
    search.count = 0;
  }
}

void Tracker::detect_in_tile(Frame& frame) {
  std::array<Detection, kRefined + MIEN_MAX_FACES> memory;
  std::span<Detection> found = std::span(memory).first(kRefined + faces_.all().size());
  {
    const StageTimer::Scope timed(timer_, MIEN_STAGE_PROPOSAL);
    found = found.first(
        proposal_.detect_in_tile(frame.view, state_.turn % proposal_.turns(frame.view), found));
    ++state_.turn;
  }
  // The best detection that is not a tracked face.
  const auto newcomer = std::find_if(found.begin(), found.end(), [&](const Detection& detection) {
    return !faces_.is_taken(detection.square);
  });
  if (newcomer != found.end()) {
    static_cast<void>(faces_.add_face(frame, *newcomer, kAlignments));
  }
}

bool Tracker::detection_is_due() {
  ++state_.frames_without_face;
  const std::int32_t waited = state_.frames_without_face - kEagerFrames;
  return waited <= 0 || waited % config_.search_interval == 0;
}

void Tracker::publish(const Frame& frame, std::int64_t pts_ns, std::uint32_t flags) {
  ++state_.frames;
  state_.face_frames += faces_.tracked() > 0 ? 1 : 0;
  state_.encoder_runs += frame.encoder_runs;
  for (Face& face : faces_.all()) {
    describe(frame, pts_ns, flags, face.result());
    face.publish(frame);
  }
  if (audio_ != nullptr) {
    mix_voice();
  }
}

// Audio cannot tell which face speaks, so it moves the one with the lowest id.
void Tracker::mix_voice() {
  Face& speaker = faces_.first();
  mien_result& result = speaker.result();
  const Mixer& mixer = audio_->mixer();
  mixer.mix(audio_->output(), speaker.video_weights(), result.controls);
  result.voice_activity = audio_->output().alpha;
  if (audio_->has_audio()) {
    result.supported_controls |= mixer.driven();
  }
}

// Fields that are equal for all faces of a frame.
void Tracker::describe(const Frame& frame, std::int64_t pts_ns, std::uint32_t flags,
                       mien_result& result) const {
  result.pts_ns = pts_ns;
  result.flags = flags;
  result.voice_activity = 0.0f;
  result.lod = frame.level;
  result.frames = state_.frames;
  result.face_frames = state_.face_frames;
  result.proposal_runs = state_.proposal_runs;
  result.encoder_runs = state_.encoder_runs;
  for (int stage = 0; stage < MIEN_STAGE_COUNT; ++stage) {
    result.stage_ns[stage] = timer_.spent_ns(static_cast<mien_stage>(stage));
  }
}

}  // namespace mien::tracker
