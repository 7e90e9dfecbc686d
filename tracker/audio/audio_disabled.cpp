// Replaces audio_track.cpp if audio is not compiled in (MIEN_WITH_AUDIO): load fails, so no tracker
// has an audio track.
#include "tracker/audio/audio_track.h"

namespace mien::tracker {

mien_status AudioTrack::load(const Models&, const mien_tracker_config&, engine::Arena&,
                             AudioTrack*& track) {
  track = nullptr;
  return MIEN_ERROR_LEFT_OUT;
}

void AudioTrack::reset() {}
mien_status AudioTrack::push(const mien_audio*, std::int64_t) { return MIEN_ERROR_LEFT_OUT; }
mien_status AudioTrack::queue(const mien_audio*, std::int64_t) { return MIEN_ERROR_LEFT_OUT; }
bool AudioTrack::has_queued() const { return false; }
void AudioTrack::process_queued() {}
void AudioTrack::advance(std::int64_t, float) {}

}  // namespace mien::tracker
