// Captures video and audio with ffmpeg.
#include "apps/mien/sources/live_source.h"

#include <algorithm>
#include <span>

#include "apps/mien/sources/capture.h"
#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/y4m_source.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

constexpr int kSampleRate = 16000;
constexpr std::size_t kBlockSamples = 160;  // 10 ms

std::vector<std::string> capture_command(CaptureKind kind, const std::string& device,
                                         std::initializer_list<const char*> output) {
  std::vector<std::string> command = {"ffmpeg",   "-hide_banner", "-nostdin",
                                      "-nostats", "-loglevel",    "error"};
  const std::vector<std::string> input = capture_arguments(kind, device);
  command.insert(command.end(), input.begin(), input.end());
  command.insert(command.end(), output.begin(), output.end());
  return command;
}

std::size_t read_process(void* context, std::span<std::byte> into) {
  return static_cast<Subprocess*>(context)->read(into);
}

std::string error_of(Subprocess& decoder) {
  const std::string line = last_line(decoder.take_errors());
  return line.empty() ? "no more data" : line;
}

}  // namespace

LiveVideo::LiveVideo(const std::string& camera)
    : camera_(camera),
      decoder_(capture_command(CaptureKind::kCamera, camera,
                               {"-map", "0:v:0", "-vsync", "passthrough", "-pix_fmt", "yuv420p",
                                "-flush_packets", "1", "-f", "yuv4mpegpipe", "-"}),
               Subprocess::Pipe::kFromChild) {}

void LiveVideo::open() {
  if (reader_.open({read_process, &decoder_}) != formats::Y4mStatus::kOk) {
    throw Failure(kExitNoInput, camera_ + ": no image: " + reason());
  }
  frame_.resize(reader_.header().frame_bytes());
}

bool LiveVideo::next(mien_image& image, std::int64_t& pts_ns) {
  if (frame_.empty()) {
    open();
  }
  if (reader_.read_frame(frame_) != formats::Y4mStatus::kOk) {
    return false;
  }
  pts_ns = steady_now_ns();
  image = y4m_image(reader_.header(), frame_.data());
  return true;
}

std::string LiveVideo::reason() { return error_of(decoder_); }

LiveAudio::LiveAudio(const std::string& microphone)
    : microphone_(microphone),
      decoder_(capture_command(CaptureKind::kMicrophone, microphone,
                               {"-map", "0:a:0", "-ac", "1", "-ar", "16000", "-flush_packets", "1",
                                "-f", "s16le", "-"}),
               Subprocess::Pipe::kFromChild),
      clock_(kSampleRate),
      samples_(kBlockSamples) {}

bool LiveAudio::next(Audio& block, std::int64_t& pts_ns) {
  const std::size_t bytes = decoder_.read(std::as_writable_bytes(std::span(samples_)));
  if (bytes < samples_.size() * sizeof samples_[0]) {
    return false;
  }
  block = Audio();
  block.format = MIEN_SAMPLES_INT16;
  block.sample_rate = kSampleRate;
  block.frames = samples_.size();
  block.samples[0] = samples_.data();
  pts_ns = clock_.time_of(static_cast<std::int64_t>(samples_.size()), steady_now_ns());
  return true;
}

std::string LiveAudio::reason() { return error_of(decoder_); }

}  // namespace mien::app
