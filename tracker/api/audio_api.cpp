// C API: audio.
#include <mien/mien.h>

#include <cstddef>

#include "kernels/float_mode.h"
#include "tracker/api/tracker_handle.h"

using mien::kernels::FloatMode;

mien_status mien_tracker_advance(mien_tracker* tracker, int64_t pts_ns) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const FloatMode float_mode;
  tracker->tracker.advance(pts_ns);
  return MIEN_OK;
}

mien_status mien_tracker_push_audio(mien_tracker* tracker, const mien_audio* audio,
                                    int64_t pts_ns) {
  const FloatMode float_mode;
  return tracker != nullptr ? tracker->tracker.push_audio(audio, pts_ns) : MIEN_ERROR_NULL_ARGUMENT;
}

mien_status mien_tracker_queue_audio(mien_tracker* tracker, const mien_audio* audio,
                                     int64_t pts_ns) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const FloatMode float_mode;
  mien::tracker::AudioTrack* audio_track = tracker->tracker.voice();
  return audio_track != nullptr ? audio_track->queue(audio, pts_ns) : MIEN_ERROR_NO_AUDIONET;
}

mien_status mien_tracker_set_audio_offset(mien_tracker* tracker, int64_t offset_ns) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  mien::tracker::AudioTrack* audio_track = tracker->tracker.voice();
  if (audio_track == nullptr) {
    return MIEN_ERROR_NO_AUDIONET;
  }
  audio_track->set_offset(offset_ns);
  return MIEN_OK;
}

mien_status mien_tracker_set_mix(mien_tracker* tracker, int32_t control, float audio_weight,
                                 float video_weight) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  mien::tracker::AudioTrack* audio_track = tracker->tracker.voice();
  if (audio_track == nullptr) {
    return MIEN_ERROR_NO_AUDIONET;
  }
  const FloatMode float_mode;
  const bool known = control >= 0 && control < MIEN_CONTROL_COUNT;
  return known && audio_track->mixer().set_weights(static_cast<std::size_t>(control), audio_weight,
                                                   video_weight)
             ? MIEN_OK
             : MIEN_ERROR_OUT_OF_RANGE;
}

void mien_audio_default(mien_audio* audio) {
  if (audio == nullptr) {
    return;
  }
  *audio = {};
  audio->struct_size = sizeof *audio;
  audio->sample_rate = 48000;
  audio->channels = 1;
}
