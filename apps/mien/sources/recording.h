// The streams of an input, as ffprobe describes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mien::app {

// Larger images are rejected before they are decoded: 8192 x 8192 pixels.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

struct VideoTrack {
  int index = 0;  // among all streams
  std::string codec;
  int width = 0;  // coded pixels
  int height = 0;
  double pixel_aspect = 1.0;  // width / height of a coded pixel
  int rotation = 0;           // degrees clockwise that make it upright
  std::string time_base;      // of its timestamps, in ffmpeg's notation: "1/15360"
  double fps = 30.0;
  std::optional<std::int64_t> frames;  // an estimate, for display only
};

struct AudioTrack {
  int index = 0;  // among all streams
  std::string codec;
};

struct Recording {
  std::optional<VideoTrack> video;  // the first; cover images do not count
  std::vector<AudioTrack> audio;    // those that ffmpeg can decode
};

struct DisplaySize {
  int width = 0;
  int height = 0;
};

// The size of the upright image in square pixels: the height stays, the width follows the pixel
// aspect ratio. `rotation` overrides that of the track.
[[nodiscard]] DisplaySize display_size(const VideoTrack& track, std::optional<int> rotation);

// Throws Failure if the file does not exist, if ffprobe cannot read it, or if it has neither video
// nor audio.
[[nodiscard]] Recording probe_recording(const std::string& input);

// Throws Failure if ffmpeg can read no video in the input.
void require_video(const std::string& input);

}  // namespace mien::app
