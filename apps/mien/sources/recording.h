// What an input holds, as ffprobe describes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mien::app {

// More pixels than this are refused before they are decoded: 8192 x 8192.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

struct VideoTrack {
  int index = 0;  // among all streams
  std::string codec;
  int width = 0;  // pixels as coded
  int height = 0;
  double pixel_aspect = 1.0;  // width of a coded pixel / its height
  int rotation = 0;           // degrees clockwise that make it upright
  std::string time_base;      // of its timestamps, as ffmpeg writes it: "1/15360"
  double fps = 30.0;
  std::optional<std::int64_t> frames;  // an estimate; nothing is decided by it
};

struct AudioTrack {
  int index = 0;  // among all streams
  std::string codec;
};

struct Recording {
  std::optional<VideoTrack> video;  // the first; a cover image does not count
  std::vector<AudioTrack> audio;    // those that ffmpeg knows how to decode
};

struct DisplaySize {
  int width = 0;
  int height = 0;
};

// Of the upright picture in square pixels: the height stays, the width follows the pixel aspect.
// `rotation` replaces that of the track.
[[nodiscard]] DisplaySize display_size(const VideoTrack& track, std::optional<int> rotation);

// Throws Failure where there is no such file, where ffprobe cannot read it, and where it has
// neither video nor audio.
[[nodiscard]] Recording probe_recording(const std::string& input);

// Throws Failure where an input has no video that ffmpeg can read.
void require_video(const std::string& input);

}  // namespace mien::app
