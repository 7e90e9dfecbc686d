// Frames of a video, whatever they come from.
#pragma once

#include <mien/mien.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace mien::app {

struct VideoInfo {
  int width = 0;   // square pixels of the upright picture
  int height = 0;  // square pixels of the upright picture
  double fps = 30.0;
  std::optional<std::int64_t> frames;  // an estimate, for progress alone
  double pixel_aspect = 1.0;           // of the coded picture: width of a pixel / its height
  int rotation = 0;                    // degrees clockwise that made it upright
};

struct VideoRange {
  double start_s = 0.0;
  std::optional<double> duration_s;
};

// Of what an input holds, what is read, and how.
struct InputOptions {
  VideoRange range;
  std::optional<int> rotation;  // degrees clockwise; none: as the input says
  int audio_track = 1;          // the first is 1
};

// What a decoder complained of that it could pass over.
struct Damage {
  std::int64_t complaints = 0;
  bool frames_lost = false;
  std::string last;  // of the complaints
};

// Reads frame by frame. The image of `next` stays valid until the next call.
class VideoSource {
 public:
  virtual ~VideoSource() = default;
  virtual const VideoInfo& info() const = 0;

  // False at the end of the video. Throws Failure when the video is truncated.
  virtual bool next(mien_image& image, std::int64_t& pts_ns) = 0;

  // So far.
  [[nodiscard]] virtual Damage damage() const { return {}; }
};

// "-" is a Y4M stream on stdin, a name ending in .y4m a Y4M file unless ffmpeg alone can read it;
// everything else goes through ffmpeg. Throws Failure.
std::unique_ptr<VideoSource> open_video(const std::string& input, const InputOptions& options);

}  // namespace mien::app
