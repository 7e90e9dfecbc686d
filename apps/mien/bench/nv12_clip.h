// A video in memory as NV12, as cameras deliver it, so that measurements exclude decoding.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <string>
#include <vector>

namespace mien::app {

class Nv12Clip {
 public:
  static constexpr int kWidth = 640,
                       kHeight = 480;  // pixels; other aspect ratios get black borders

  // Decodes the first `max_frames` frames. Throws Failure.
  Nv12Clip(const std::string& input, std::size_t max_frames);

  [[nodiscard]] std::size_t frames() const { return bytes_.size() / kFrameBytes; }
  [[nodiscard]] mien_image frame(std::size_t index) const;

 private:
  static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  static constexpr std::size_t kFrameBytes = kPixels * 3 / 2;

  std::vector<std::byte> bytes_;
};

}  // namespace mien::app
