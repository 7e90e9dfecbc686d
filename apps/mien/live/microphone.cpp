// Queues audio for a tracker.
#include "apps/mien/live/microphone.h"

namespace mien::app {

Microphone::Microphone(const std::string& name, Tracker& tracker)
    : CaptureThread(
          name,
          name.starts_with(kTest) ? open_audio_source(name.substr(kTest.size()), {}) : nullptr,
          true),
      tracker_(tracker) {}

bool Microphone::ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

// The queue is full if the tracker processes no images. The dropped audio becomes a gap.
void Microphone::take(const Audio& block, std::int64_t time_ns, std::int64_t /*arrival_ns*/) {
  const mien_status status = tracker_.queue_audio(block, time_ns);
  if (status != MIEN_OK && status != MIEN_ERROR_AUDIO_QUEUE_FULL) {
    throw Failure(kExitInternal, name() + ": " + message(status));
  }
}

}  // namespace mien::app
