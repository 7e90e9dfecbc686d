// Converts results to animation frames.
#include "apps/mien/outputs/result_frame.h"

#include "apps/animation/numbers.h"

namespace mien::app {
namespace {

using animation::decimal;
using animation::FaceState;

static_assert(MIEN_CONTROL_COUNT == formats::kControlCount);

FaceState state(std::int32_t status) {
  switch (status) {
    case MIEN_FACE_TRACKING:
      return FaceState::kTracking;
    case MIEN_FACE_LOST:
      return FaceState::kLost;
    default:
      return FaceState::kSearching;
  }
}

}  // namespace

animation::Frame frame_of(std::int64_t number, const Result& result) {
  animation::Frame frame;
  frame.number = number;
  frame.time_ns = result.pts_ns;
  frame.state = state(result.status);
  frame.face_id = result.face_id;
  frame.face_probability = decimal(result.face_probability);
  frame.voice_activity = decimal(result.voice_activity);
  frame.lod = result.lod;
  if (result.has_face()) {  // without a face they are those of the last one
    const float* box = result.box;
    const float* place = result.translation;
    frame.box = {decimal(box[0]), decimal(box[1]), decimal(box[2]), decimal(box[3])};
    frame.head = {decimal(result.pitch), decimal(result.yaw), decimal(result.roll)};
    frame.position_m = {decimal(place[0]), decimal(place[1]), decimal(place[2])};
  }
  for (std::int32_t i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    if (result.supports(i)) {
      frame.controls[static_cast<std::size_t>(i)] = decimal(result.controls[i]);
    }
  }
  return frame;
}

}  // namespace mien::app
