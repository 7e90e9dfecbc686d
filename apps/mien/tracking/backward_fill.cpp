// Holds frames without a face, tracks backward, and merges the results.
#include "apps/mien/tracking/backward_fill.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

namespace mien::app {
namespace {

// The second tracker begins this many frames after the detection, so that its decoders have settled
// before their controls are used.
constexpr std::int64_t kWarmUp = 10;
constexpr float kSamePlace =
    0.4f;  // distance of the centres of one face's boxes, relative to the box
constexpr float kMinProbability = 0.5f;         // face probability; results below it are unreliable
constexpr std::int64_t kCutNs = 1'000'000'000;  // longer steps are cuts
constexpr float kFadeSeconds = 0.25f;           // of controls after a loss, as in the tracker

bool is_same_place(const Result& a, const Result& b) {
  const float x = (a.box[0] + a.box[2] / 2) - (b.box[0] + b.box[2] / 2);
  const float y = (a.box[1] + a.box[3] / 2) - (b.box[1] + b.box[3] / 2);
  return std::hypot(x, y) < kSamePlace * std::max(a.box[2], b.box[2]);
}

// The tracked face with this id; nullptr: none.
const Result* tracked(std::span<const Result> faces, std::uint32_t face_id) {
  const auto found = std::find_if(faces.begin(), faces.end(), [=](const Result& face) {
    return face.has_face() && face.face_id == face_id;
  });
  return found != faces.end() ? &*found : nullptr;
}

bool has_any_face(std::span<const Result> faces) {
  return std::any_of(faces.begin(), faces.end(),
                     [](const Result& face) { return face.has_face(); });
}

// Copies the values of a tracked face into a row and keeps the rest of the row.
void copy_face(const Result& from, Result& to) {
  to.status = MIEN_FACE_TRACKING;
  to.face_probability = from.face_probability;
  std::copy(std::begin(from.box), std::end(from.box), to.box);
  std::copy(std::begin(from.rotation), std::end(from.rotation), to.rotation);
  std::copy(std::begin(from.translation), std::end(from.translation), to.translation);
  to.pitch = from.pitch;
  to.yaw = from.yaw;
  to.roll = from.roll;
  std::memcpy(to.landmarks, from.landmarks, sizeof to.landmarks);
}

}  // namespace

BackwardFill::BackwardFill(const LoadedTracker::Options& tracker, const std::string& neutral,
                           Sink sink)
    : options_(tracker), mixes_audio_(tracker.sound), neutral_(neutral), sink_(std::move(sink)) {
  options_.sound = false;
}

void BackwardFill::add(std::int64_t number, const mien_image& image, std::vector<Result> faces) {
  if (rows_.empty() && is_complete(faces)) {
    lost_ = faces.front();
    sink_(number, &image, faces);
    return;
  }
  rows_.push_back({number, HeldImage(image), std::move(faces)});
  held_bytes_ += rows_.back().image.bytes();
  note_detections();
  while (!detections_.empty() && is_due(detections_.front())) {
    fill_before(detections_.front());
    detections_.erase(detections_.begin());
  }
  release();
}

void BackwardFill::finish() {
  for (const Detection& detection : detections_) {
    fill_before(detection);
  }
  detections_.clear();
  while (!rows_.empty()) {
    release_first();
  }
}

bool BackwardFill::is_complete(std::span<const Result> faces) const {
  return std::count_if(faces.begin(), faces.end(),
                       [](const Result& face) { return face.has_face(); }) == options_.max_faces;
}

void BackwardFill::note_detections() {
  const Row& newest = rows_.back();
  for (const Result& face : newest.faces) {
    if (rows_.size() > 1 && face.has_face() && (face.flags & MIEN_RESULT_FOUND) != 0) {
      detections_.push_back({face.face_id, newest.number});
    }
  }
}

bool BackwardFill::is_due(const Detection& detection) const {
  const Row& newest = rows_.back();
  return newest.number >= detection.number + kWarmUp ||
         tracked(newest.faces, detection.face_id) == nullptr;
}

std::size_t BackwardFill::row_of(std::int64_t number) const {
  const std::int64_t first = rows_.empty() ? number : rows_.front().number;
  return static_cast<std::size_t>(std::max(number - first, std::int64_t{0}));
}

void BackwardFill::fill_before(const Detection& detection) {
  const std::size_t first = row_of(detection.number);
  std::size_t last = first;
  while (last + 1 < rows_.size() && tracked(rows_[last + 1].faces, detection.face_id) != nullptr) {
    ++last;
  }
  if (first == 0 || first >= rows_.size()) {
    return;
  }
  const std::vector<Result> found = track_backward(detection.face_id, first, last);
  for (std::size_t i = 0; i < found.size(); ++i) {
    fill(first - 1 - i, detection.face_id, found[i]);
  }
  for (std::size_t i = 0; options_.max_faces == 1 && i <= last; ++i) {
    rows_[i].is_final = true;
  }
}

void BackwardFill::start_tracker(std::int32_t lod) {
  if (!tracker_) {
    tracker_.emplace(options_);
    if (mixes_audio_) {
      mix_ = AudioMix(Blob(models_directory(options_.models) + "/audionet.mien"));
    }
  }
  check(tracker_->tracker.reset(), "tracking backward");
  check(tracker_->tracker.set_lod(lod), "tracking backward");
  if (!neutral_.empty()) {
    load_neutral(neutral_, tracker_->tracker);
  }
}

std::vector<Result> BackwardFill::faces_on(const Row& row, std::int64_t pts_ns) {
  const std::string where = "tracking backward: frame " + std::to_string(row.number);
  check(tracker_->tracker.push_video(row.image.image(), pts_ns), where);
  return results(tracker_->tracker, where);
}

std::vector<Result> BackwardFill::track_backward(std::uint32_t face_id, std::size_t first,
                                                 std::size_t last) {
  const Result& target = *tracked(rows_[last].faces, face_id);
  start_tracker(target.lod);
  const std::vector<Result> begin = faces_on(rows_[last], 0);
  const auto start = std::find_if(begin.begin(), begin.end(), [&](const Result& face) {
    return face.has_face() && is_same_place(face, target);
  });
  std::vector<Result> found;
  if (start == begin.end()) {
    return found;
  }
  std::size_t confirmed = 0;
  for (std::size_t i = last; i-- > 0;) {
    const Row& row = rows_[i];
    const std::int64_t pts_ns = row.faces.front().pts_ns;
    if (rows_[i + 1].faces.front().pts_ns - pts_ns > kCutNs ||
        (i < first && is_complete(row.faces))) {
      break;
    }
    const std::vector<Result> faces = faces_on(row, target.pts_ns - pts_ns);
    const Result* face = tracked(faces, start->face_id);
    if (face == nullptr) {
      break;
    }
    if (i >= first) {
      continue;
    }
    if (std::any_of(row.faces.begin(), row.faces.end(), [&](const Result& other) {
          return other.has_face() && is_same_place(other, *face);
        })) {
      break;
    }
    found.push_back(*face);
    const bool is_verified = (face->flags & MIEN_RESULT_ENCODER_RAN) != 0;
    confirmed = is_verified && face->face_probability >= kMinProbability ? found.size() : confirmed;
  }
  found.resize(confirmed);
  return found;
}

void BackwardFill::fill(std::size_t row, std::uint32_t face_id, const Result& found) {
  std::vector<Result>& faces = rows_[row].faces;
  const bool alone = !has_any_face(faces);
  Result filled = faces.front();
  copy_face(found, filled);
  if (alone) {
    const Controls mixed = mix_.controls(found, faces.front(), fading(row));
    std::copy(mixed.begin(), mixed.end(), filled.controls);
    filled.supported_controls |= found.supported_controls;
    ++filled_;
  } else {
    std::copy(std::begin(found.controls), std::end(found.controls), filled.controls);
    filled.supported_controls = found.supported_controls;
  }
  filled.face_id = face_id;
  std::erase_if(faces, [&](const Result& face) {
    return !face.has_face() &&
           (face.face_id == 0 || face.face_id == face_id || options_.max_faces == 1);
  });
  const auto after = std::find_if(faces.begin(), faces.end(),
                                  [&](const Result& face) { return face.face_id > face_id; });
  faces.insert(after, filled);
}

BackwardFill::Controls BackwardFill::fading(std::size_t row) const {
  Controls controls = {};
  const Result& now = rows_[row].faces.front();
  const Result* lost = lost_ ? &*lost_ : nullptr;
  for (std::size_t i = 0; i < row; ++i) {
    const Result& face = rows_[i].faces.front();
    lost = face.has_face() ? &face : lost;
  }
  if (lost != nullptr && now.status == MIEN_FACE_LOST) {
    const float seconds = static_cast<float>(now.pts_ns - lost->pts_ns) * 1e-9f;
    const float left = std::exp(-std::max(seconds, 0.0f) / kFadeSeconds);
    std::transform(std::begin(lost->controls), std::end(lost->controls), controls.begin(),
                   [left](float control) { return left * control; });
  }
  return controls;
}

void BackwardFill::release() {
  const auto may_leave = [&](const Row& row) {
    const std::int64_t held_ns = rows_.back().faces.front().pts_ns - row.faces.front().pts_ns;
    return row.is_final || is_complete(row.faces) || held_ns > kMaxHeldNs ||
           held_bytes_ > kMaxHeldBytes;
  };
  while (!rows_.empty() && may_leave(rows_.front())) {
    release_first();
  }
}

void BackwardFill::release_first() {
  const Row& row = rows_.front();
  if (row.faces.front().has_face()) {
    lost_ = row.faces.front();
  }
  sink_(row.number, &row.image.image(), row.faces);
  held_bytes_ -= row.image.bytes();
  rows_.pop_front();
}

}  // namespace mien::app
