// The latest image of a camera. An image that is not taken before the next one arrives is dropped:
// a slow consumer gets fewer images, but no late ones.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/mien/live/capture_thread.h"
#include "apps/mien/sources/video_source.h"

namespace mien::app {

struct CameraImage {
  mien_image image;  // refers to pixels
  std::vector<std::byte> pixels;
  std::int64_t time_ns = 0;     // capture time on the steady clock
  std::int64_t arrival_ns = 0;  // arrival time: later if decoding was late
};

class Camera : public CaptureThread<VideoSource, LiveVideo, mien_image> {
 public:
  // "none": no images; "test:FILE": a file in real time; otherwise a device or a URL. `retries`: a
  // device that is missing at the start is retried instead of being a failure. Throws Failure if a
  // file has no image.
  Camera(const std::string& name, bool retries);
  ~Camera() override { stop(); }

  void start(std::int64_t begin_ns);

  // Returns the latest image not taken yet, and waits for it until `until_ns`; nullptr if there is
  // none. Valid until the next call. Rethrows the failure of a camera that never delivered an
  // image.
  const CameraImage* newest(std::int64_t until_ns);

  // Whether the file has ended and its last image was taken.
  [[nodiscard]] bool ended();
  [[nodiscard]] std::uint64_t dropped();

 private:
  void take(const mien_image& image, std::int64_t time_ns, std::int64_t arrival_ns) override;

  CameraImage latest_;  // guarded by the mutex, as the following two
  bool has_new_ = false;
  std::uint64_t dropped_ = 0;

  CameraImage writing_;  // used by the camera's thread
  CameraImage reading_;  // used by the caller's thread
};

}  // namespace mien::app
