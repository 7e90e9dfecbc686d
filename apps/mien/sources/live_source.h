// Video and audio from a camera, a microphone or a network, in real time. Timestamps are arrival
// times on the steady clock, in nanoseconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/sample_clock.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/subprocess.h"
#include "formats/y4m.h"

namespace mien::app {

// The current time on the clock of live timestamps.
[[nodiscard]] inline std::int64_t steady_now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

class LiveVideo {
 public:
  // Starts to open the camera. Throws Failure.
  explicit LiveVideo(const std::string& camera);

  // Waits for the next image, which is valid until the next call. Returns false after the camera
  // has ended. Throws Failure(kExitNoInput) if there is no first image.
  bool next(mien_image& image, std::int64_t& pts_ns);
  // Ends a wait from another thread.
  void interrupt() { decoder_.interrupt(); }
  // The last error of the decoder.
  std::string reason();

 private:
  void open();

  std::string camera_;
  Subprocess decoder_;
  formats::Y4mReader reader_;
  std::vector<std::byte> frame_;
};

class LiveAudio {
 public:
  explicit LiveAudio(const std::string& microphone);  // throws Failure

  // Waits for the next block, which is valid until the next call. Returns false at the end.
  bool next(Audio& block, std::int64_t& pts_ns);
  void interrupt() { decoder_.interrupt(); }
  std::string reason();

 private:
  std::string microphone_;
  Subprocess decoder_;
  SampleClock clock_;
  std::vector<std::int16_t> samples_;
};

}  // namespace mien::app
