// Merges resampled faces in order of time.
#include "apps/mien/convert/even_frames.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

using animation::Frame;
using animation::FrameSequence;

constexpr double kMaxFrames = 1e7;
constexpr std::size_t kMaxFaces = 1000;

}  // namespace

EvenFrames::EvenFrames(FrameSequence frames, double fps) {
  const std::int64_t first_ns = frames.first_time_ns();
  split(std::move(frames));
  double count = 0.0;
  for (const FrameSequence& part : parts_) {
    count += animation::Resampler::count(part, fps);
  }
  if (!(count <= kMaxFrames)) {
    throw Failure(kExitUsage, "--fps: more than ten million frames");
  }
  for (const FrameSequence& part : parts_) {
    faces_.push_back({animation::Resampler(part, fps, first_ns), Frame()});
    take_next(faces_.size() - 1);
  }
}

// Frames without an id belong to the only face with an id, if there is exactly one.
void EvenFrames::split(FrameSequence frames) {
  std::map<std::int64_t, std::size_t> ids;
  for (const Frame& frame : frames) {
    ids.try_emplace(frame.face_id, 0);
    if (ids.size() > kMaxFaces) {
      throw Failure(kExitUsage, "--fps: more than 1000 faces; select one with --face");
    }
  }
  if (ids.size() - (ids.contains(0) ? 1 : 0) <= 1) {
    parts_.push_back(std::move(frames));
    return;
  }
  for (std::size_t which = 0; auto& [id, part] : ids) {
    part = which++;
  }
  parts_.resize(ids.size());
  frames.consume([&](const Frame& frame) { parts_[ids.at(frame.face_id)].push_back(frame); });
}

void EvenFrames::take_next(std::size_t face) {
  if (std::optional<Frame> next = faces_[face].resampler.next()) {
    faces_[face].frame = *std::move(next);
    heap_.push_back(face);
    std::push_heap(heap_.begin(), heap_.end(),
                   [this](std::size_t a, std::size_t b) { return later(a, b); });
  }
}

bool EvenFrames::later(std::size_t a, std::size_t b) const {
  return std::pair(faces_[a].frame.time_ns, a) > std::pair(faces_[b].frame.time_ns, b);
}

std::optional<Frame> EvenFrames::next() {
  if (heap_.empty()) {
    return std::nullopt;
  }
  std::pop_heap(heap_.begin(), heap_.end(),
                [this](std::size_t a, std::size_t b) { return later(a, b); });
  const std::size_t face = heap_.back();
  heap_.pop_back();
  const Frame frame = faces_[face].frame;
  take_next(face);
  return frame;
}

}  // namespace mien::app
