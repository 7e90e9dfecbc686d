// Converts decoded video packets to images.
#include "apps/mien/sources/decoded_video.h"

#include <cmath>
#include <utility>

#include "apps/mien/system/failure.h"

namespace mien::app {

DecodedVideo::DecodedVideo(std::string input, const VideoRange& range, const VideoInfo& info,
                           std::shared_ptr<Decoder> decoder, std::size_t stream)
    : input_(std::move(input)),
      range_(range),
      info_(info),
      decoder_(std::move(decoder)),
      stream_(stream) {}

bool DecodedVideo::next_in_range(std::int64_t& pts_ns) {
  constexpr double kRounding = 1e-6;  // ffmpeg rounds the times of a range to microseconds
  while (decoder_->next(stream_, packet_)) {
    const double time_s = packet_.time_s - range_.start_s;
    if (range_.duration_s && time_s >= *range_.duration_s - kRounding) {
      return false;
    }
    if (time_s >= -kRounding || range_.start_s == 0.0) {
      pts_ns = std::llround(packet_.time_s * 1e9);
      return true;
    }
  }
  at_end();
  return false;
}

bool DecodedVideo::next(mien_image& image, std::int64_t& pts_ns) {
  if (!next_in_range(pts_ns)) {
    if (frames_ == 0) {
      throw Failure(kExitNoVideo, input_ + ": no image in the range");
    }
    return false;
  }
  const std::size_t bytes =
      static_cast<std::size_t>(info_.width) * static_cast<std::size_t>(info_.height) * 3;
  if (packet_.data.size() != bytes) {
    throw Failure(kExitInternal, input_ + ": ffmpeg: wrong image size (got " +
                                     std::to_string(packet_.data.size()) + " bytes, expected " +
                                     std::to_string(bytes) + ")");
  }
  mien_image_default(&image);
  image.format = MIEN_IMAGE_RGB;
  image.width = info_.width;
  image.height = info_.height;
  image.planes[0] = packet_.data.data();
  image.row_stride_bytes[0] = info_.width * 3;
  ++frames_;
  return true;
}

void DecodedVideo::at_end() const {
  const std::string& last = decoder_->damage().last;
  const std::string reason = last.empty() ? "" : ": " + last;
  if (decoder_->failed() && frames_ == 0) {
    throw Failure(kExitNoVideo, input_ + ": cannot be decoded" + reason);
  }
  if (decoder_->failed() || decoder_->ended_early()) {
    throw Failure(kExitTruncated,
                  input_ + ": truncated after " + std::to_string(frames_) + " frames" + reason);
  }
}

}  // namespace mien::app
