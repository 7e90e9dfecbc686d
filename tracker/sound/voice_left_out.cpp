// In place of voice.cpp in a build without sound (MIEN_WITH_SOUND): no tracker ever gets a voice.
#include "tracker/sound/voice.h"

namespace mien::tracker {

mien_status Voice::load(const Models&, const mien_tracker_config&, engine::Arena&, Voice*& voice) {
  voice = nullptr;
  return MIEN_ERROR_LEFT_OUT;
}

void Voice::reset() {}
mien_status Voice::push(const mien_audio*, std::int64_t) { return MIEN_ERROR_LEFT_OUT; }
mien_status Voice::queue(const mien_audio*, std::int64_t) { return MIEN_ERROR_LEFT_OUT; }
bool Voice::has_queued() const { return false; }
void Voice::hear_queued() {}
void Voice::advance(std::int64_t, float) {}

}  // namespace mien::tracker
