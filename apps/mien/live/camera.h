// The newest picture of a camera. Pictures that nobody has taken when the next one comes are
// dropped: whoever is slow sees fewer pictures, and never old ones.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/mien/live/capture_thread.h"
#include "apps/mien/sources/video_source.h"

namespace mien::app {

struct Picture {
  mien_image image;  // points into pixels
  std::vector<std::byte> pixels;
  std::int64_t time_ns = 0;   // on the steady clock, when it was taken
  std::int64_t there_ns = 0;  // when it was here: later, where decoding was late
};

class Camera : public CaptureThread<VideoSource, LiveVideo, mien_image> {
 public:
  // "none": no pictures; "test:FILE": those of a file, as if they happened; else a device or a URL.
  // Throws Failure when a file gives no picture.
  explicit Camera(const std::string& name);
  ~Camera() override { stop(); }

  void start(std::int64_t begin_ns);

  // The newest that was not taken yet, waited for until then; nullptr when there is none. Valid
  // until the next call. Throws what made the camera fail before it gave any.
  const Picture* newest(std::int64_t until_ns);

  // No more pictures will come: the file has ended.
  [[nodiscard]] bool ended();
  [[nodiscard]] std::uint64_t dropped();

 private:
  void take(const mien_image& image, std::int64_t time_ns, std::int64_t there_ns) override;

  Picture waiting_;  // it and what follows: the mutex's
  bool fresh_ = false;
  std::uint64_t dropped_ = 0;

  Picture filling_;  // of the camera's thread
  Picture taken_;    // of the taker's
};

}  // namespace mien::app
