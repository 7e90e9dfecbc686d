// An interface for the video of an input.
#pragma once

#include <mien/mien.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace mien::app {

struct VideoInfo {
  int width = 0;   // square pixels of the upright image
  int height = 0;  // square pixels of the upright image
  double fps = 30.0;
  std::optional<std::int64_t> frames;  // an estimate, for the progress bar
  double pixel_aspect = 1.0;           // width / height of a coded pixel
  int rotation = 0;                    // degrees clockwise that made it upright
};

struct VideoRange {
  double start_s = 0.0;
  std::optional<double> duration_s;
};

// The part of an input to read, and how.
struct InputOptions {
  VideoRange range;
  std::optional<int> rotation;  // degrees clockwise; default: from the input
  int audio_track = 1;          // the first is 1
};

// Errors that a decoder reported and survived.
struct Damage {
  std::int64_t complaints = 0;
  bool frames_lost = false;
  std::string last;  // last error
};

// Reads frame by frame. The image of `next` stays valid until the next call.
class VideoSource {
 public:
  virtual ~VideoSource() = default;
  virtual const VideoInfo& info() const = 0;

  // Returns false at the end of the video. Throws Failure if the video is truncated.
  virtual bool next(mien_image& image, std::int64_t& pts_ns) = 0;

  // Decoding errors until now.
  [[nodiscard]] virtual Damage damage() const { return {}; }
};

// Opens "-" as a Y4M stream on standard input, and .y4m files without ffmpeg if possible. Other
// inputs go through ffmpeg. Throws Failure.
std::unique_ptr<VideoSource> open_video(const std::string& input, const InputOptions& options);

}  // namespace mien::app
