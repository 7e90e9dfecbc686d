// Decodes a video to NV12 with ffmpeg.
#include "apps/mien/bench/nv12_clip.h"

#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/recording.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {

Nv12Clip::Nv12Clip(const std::string& input, std::size_t max_frames)
    : bytes_(max_frames * kFrameBytes) {
  require_video(input);  // its messages are clearer than those of the decoder
  const std::string size = std::to_string(kWidth) + ":" + std::to_string(kHeight);
  std::vector<std::string> command = {"ffmpeg", "-nostdin", "-v", "error"};
  const std::vector<std::string> file = input_arguments(input);
  command.insert(command.end(), file.begin(), file.end());
  command.insert(
      command.end(),
      {"-map", "0:v:0", "-vf",
       "scale=" + size + ":force_original_aspect_ratio=decrease,pad=" + size + ":-1:-1",
       "-frames:v", std::to_string(max_frames), "-pix_fmt", "nv12", "-f", "rawvideo", "-"});
  Subprocess decoder(command, Subprocess::Pipe::kFromChild, timeout_of(input));
  const std::size_t got = decoder.read(bytes_);
  if (decoder.finish() != 0 || got == 0 || got % kFrameBytes != 0) {
    throw Failure(kExitNoVideo, input + ": cannot be decoded: " + last_line(decoder.take_errors()));
  }
  bytes_.resize(got);
}

mien_image Nv12Clip::frame(std::size_t index) const {
  mien_image image;
  mien_image_default(&image);
  image.format = MIEN_IMAGE_NV12;
  image.width = kWidth;
  image.height = kHeight;
  image.full_range = 0;
  const std::byte* luma = bytes_.data() + index * kFrameBytes;
  image.planes[0] = luma;
  image.planes[1] = luma + kPixels;
  image.row_stride_bytes[0] = image.row_stride_bytes[1] = kWidth;
  return image;
}

}  // namespace mien::app
