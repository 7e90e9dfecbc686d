// A clip in memory as a camera would deliver it, so that nothing but the tracker is timed.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <string>
#include <vector>

namespace mien::app {

class Nv12Clip {
 public:
  static constexpr int kWidth = 640, kHeight = 480;  // pixels; other shapes get black borders

  // The first `most` frames of whatever ffmpeg reads. Throws Failure.
  Nv12Clip(const std::string& input, std::size_t most);

  [[nodiscard]] std::size_t frames() const { return bytes_.size() / kFrameBytes; }
  [[nodiscard]] mien_image frame(std::size_t index) const;

 private:
  static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  static constexpr std::size_t kFrameBytes = kPixels * 3 / 2;

  std::vector<std::byte> bytes_;
};

}  // namespace mien::app
