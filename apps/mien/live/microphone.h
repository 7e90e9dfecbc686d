// A microphone, heard by a tracker from a thread of its own.
#pragma once

#include <cstdint>
#include <mien/mien.hpp>
#include <string>

#include "apps/mien/live/capture_thread.h"
#include "apps/mien/sources/audio_source.h"

namespace mien::app {

class Microphone : public CaptureThread<AudioSource, LiveSound, Audio> {
 public:
  // "test:FILE": the sound of a file, as if it happened; else a device or a URL, which is waited
  // for. The tracker has room for half a second (mien_tracker_config.audio_queue_samples) and
  // outlives this. Throws Failure when a file has no sound.
  Microphone(const std::string& name, Tracker& tracker);
  ~Microphone() override { stop(); }

  // No more will come: the file has ended.
  [[nodiscard]] bool ended();

 private:
  void take(const Audio& block, std::int64_t time_ns, std::int64_t there_ns) override;

  Tracker& tracker_;
};

}  // namespace mien::app
