// Runs ffmpeg as an encoder with a constant frame rate.
#include "apps/mien/outputs/video_encoder.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

struct Muxer {
  std::string_view ending, name;
};

// ffmpeg's default formats for common endings. With an explicit format, ffmpeg can write to a file
// without an ending.
constexpr std::array<Muxer, 5> kMuxers = {
    {{".mp4", "mp4"}, {".mov", "mov"}, {".mkv", "matroska"}, {".avi", "avi"}, {".ts", "mpegts"}}};

std::string_view muxer_of(const std::string& path) {
  const std::string ending = name_of(path_of(path).extension());
  const auto* known = std::find_if(kMuxers.begin(), kMuxers.end(),
                                   [&](const Muxer& muxer) { return muxer.ending == ending; });
  return known == kMuxers.end() ? std::string_view() : known->name;
}

TemporaryFile::Ending needed_ending(const std::string& path) {
  return muxer_of(path).empty() ? TemporaryFile::Ending::kOfDestination
                                : TemporaryFile::Ending::kAny;
}

std::vector<std::string> encode_command(const std::string& partial_path, std::string_view muxer,
                                        int width, int height, double fps,
                                        const std::string& audio_from, int audio_track,
                                        const VideoRange& range) {
  std::vector<std::string> command = {"ffmpeg",
                                      "-hide_banner",
                                      "-loglevel",
                                      "error",
                                      "-y",
                                      "-f",
                                      "rawvideo",
                                      "-pix_fmt",
                                      "rgb24",
                                      "-video_size",
                                      std::to_string(width) + "x" + std::to_string(height),
                                      "-framerate",
                                      std::to_string(fps),
                                      "-i",
                                      "-"};
  if (!audio_from.empty()) {
    if (range.start_s > 0.0) {
      command.insert(command.end(), {"-ss", std::to_string(range.start_s)});
    }
    if (range.duration_s) {
      command.insert(command.end(), {"-t", std::to_string(*range.duration_s)});
    }
    const std::vector<std::string> source = input_arguments(audio_from);
    command.insert(command.end(), source.begin(), source.end());
    command.insert(command.end(), {"-map", "1:a:" + std::to_string(audio_track - 1) + "?"});
  }
  // H.264 in 4:2:0 needs even sizes.
  command.insert(command.end(),
                 {"-map", "0:v", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p",
                  "-crf", "20", "-preset", "veryfast", "-movflags", "+faststart"});
  if (!muxer.empty()) {
    command.insert(command.end(), {"-f", std::string(muxer)});
  }
  command.push_back(output_file(partial_path));
  if (!audio_from.empty()) {  // reads the video, so that time 0 is the start of the recording, not
                              // of its audio
    command.insert(command.end(), {"-map", "1:v:0", "-c", "copy", "-f", "null", "-"});
  }
  return command;
}

}  // namespace

VideoEncoder::VideoEncoder(const std::string& path, int width, int height, double fps,
                           const std::string& audio_from, int audio_track, const VideoRange& range)
    : path_(path),
      fps_(fps),
      start_s_(range.start_s),
      partial_(path, needed_ending(path)),
      encoder_(encode_command(partial_.name(), muxer_of(path), width, height, fps, audio_from,
                              audio_track, range),
               Subprocess::Pipe::kToChild, Subprocess::kTimeout) {}

void VideoEncoder::fail() {
  std::string reason = encoder_.take_errors();
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  throw Failure(kExitOutput, path_ + ": cannot be written: " + reason);
}

// Repeats the previous image until the time of this one. The first image is shown from the start.
void VideoEncoder::write(const std::vector<unsigned char>& rgb, std::int64_t time_ns) {
  constexpr double kMaxGapS =
      600.0;  // limits the number of repeated images after a timestamp discontinuity
  const double due = (static_cast<double>(time_ns) * 1e-9 - start_s_) * fps_;
  const auto written = static_cast<double>(frames_);
  const double until = std::min(due + 0.5, written + kMaxGapS * fps_);
  if (last_image_.empty()) {
    last_image_ = rgb;
  }
  while (static_cast<double>(frames_) + 1.0 <= until) {
    send();
  }
  last_image_ = rgb;
}

void VideoEncoder::send() {
  ++frames_;
  if (!encoder_.write(std::as_bytes(std::span(last_image_)))) {
    encoder_.finish();
    fail();
  }
}

void VideoEncoder::finish() {
  if (!last_image_.empty()) {
    send();
  }
  if (encoder_.finish() != 0) {
    fail();
  }
  partial_.publish();
}

}  // namespace mien::app
