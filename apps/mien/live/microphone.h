// A microphone that feeds a tracker from its own thread.
#pragma once

#include <cstdint>
#include <mien/mien.hpp>
#include <string>

#include "apps/mien/live/capture_thread.h"
#include "apps/mien/sources/audio_source.h"

namespace mien::app {

class Microphone : public CaptureThread<AudioSource, LiveAudio, Audio> {
 public:
  // "test:FILE": the audio of a file in real time; otherwise a device or a URL, which is retried.
  // The tracker must have a queue of half a second (mien_tracker_config.audio_queue_samples) and
  // must outlive this object. Throws Failure if a file has no audio.
  Microphone(const std::string& name, Tracker& tracker);
  ~Microphone() override { stop(); }

  // Whether the file has ended.
  [[nodiscard]] bool ended();

 private:
  void take(const Audio& block, std::int64_t time_ns, std::int64_t arrival_ns) override;

  Tracker& tracker_;
};

}  // namespace mien::app
