// Frames of a video, whatever they come from.
#pragma once

#include <mien/mien.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace mien::app {

struct VideoInfo {
  int width = 0;   // pixels of the upright image
  int height = 0;  // pixels of the upright image
  double fps = 30.0;
  std::optional<std::int64_t> frames;  // how many the container promises, where it says
};

struct VideoRange {
  double start_s = 0.0;
  std::optional<double> duration_s;
};

// Reads frame by frame. The image of `next` stays valid until the next call.
class VideoSource {
 public:
  virtual ~VideoSource() = default;
  virtual const VideoInfo& info() const = 0;

  // False at the end of the video. Throws Failure when the video is damaged or truncated.
  virtual bool next(mien_image& image, std::int64_t& pts_ns) = 0;
};

// Whether that is what the input is.
bool is_y4m(const std::string& input);

// "-" is a Y4M stream on stdin, a name ending in .y4m a Y4M file; everything else goes through
// ffmpeg.
std::unique_ptr<VideoSource> open_video(const std::string& input, const VideoRange& range);

}  // namespace mien::app
