// Reads images from Y4M files.
#include "apps/mien/sources/y4m_source.h"

#include <cmath>
#include <cstdio>
#include <vector>

#include "apps/mien/sources/input_file.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/recording.h"
#include "apps/mien/system/failure.h"
#include "formats/y4m.h"

namespace mien::app {
namespace {

class Y4mSource : public VideoSource {
 public:
  Y4mSource(const std::string& input, const InputOptions& options);

  const VideoInfo& info() const override { return info_; }
  bool next(mien_image& image, std::int64_t& pts_ns) override;

 private:
  bool read_frame();
  [[nodiscard]] double seconds(std::int64_t frame) const {
    return static_cast<double>(frame) / info_.fps;
  }

  std::string name_;
  VideoRange range_;
  InputFile file_;
  formats::Y4mReader reader_;
  VideoInfo info_;
  std::vector<std::byte> frame_;
  std::int64_t frames_ = 0;
};

Y4mSource::Y4mSource(const std::string& input, const InputOptions& options)
    : name_(input_label(input)), range_(options.range), file_(open_input_file(input)) {
  const formats::Y4mStatus status = reader_.open(formats::file_source(file_.get()));
  if (status != formats::Y4mStatus::kOk) {
    throw Failure(kExitNoVideo, name_ + ": not a Y4M video: " + formats::message(status));
  }
  const formats::Y4mHeader& header = reader_.header();
  VideoTrack track;
  track.width = static_cast<int>(header.width);
  track.height = static_cast<int>(header.height);
  track.pixel_aspect = header.pixel_aspect();
  const DisplaySize size = display_size(track, options.rotation);
  info_.width = size.width;
  info_.height = size.height;
  info_.fps = static_cast<double>(header.rate_num) / static_cast<double>(header.rate_den);
  info_.pixel_aspect = track.pixel_aspect;
  info_.rotation = options.rotation.value_or(0);
  frame_.resize(header.frame_bytes());
}

bool Y4mSource::read_frame() {
  const formats::Y4mStatus status = reader_.read_frame(frame_);
  if (status == formats::Y4mStatus::kEnd) {
    return false;
  }
  if (status != formats::Y4mStatus::kOk) {
    throw Failure(kExitTruncated, name_ + ": damaged after " + std::to_string(frames_) +
                                      " frames: " + formats::message(status));
  }
  ++frames_;
  return true;
}

bool Y4mSource::next(mien_image& image, std::int64_t& pts_ns) {
  do {
    const double time = seconds(frames_);
    if (range_.duration_s && time >= range_.start_s + *range_.duration_s) {
      return false;
    }
    if (!read_frame()) {
      return false;
    }
  } while (seconds(frames_ - 1) < range_.start_s);
  image = y4m_image(reader_.header(), frame_.data());
  image.rotation = info_.rotation;
  pts_ns = std::llround(seconds(frames_ - 1) * 1e9);
  return true;
}

}  // namespace

// Reads 4:2:2 and 4:4:4 as 4:2:0 by skipping chroma samples.
mien_image y4m_image(const formats::Y4mHeader& header, const std::byte* frame) {
  const auto width = static_cast<int>(header.width), height = static_cast<int>(header.height);
  mien_image image;
  mien_image_default(&image);
  image.width = width;
  image.height = height;
  image.full_range = header.full_range ? 1 : 0;
  image.pixel_aspect = static_cast<float>(header.pixel_aspect());
  image.planes[0] = frame;
  image.row_stride_bytes[0] = width;
  if (header.colour == formats::Y4mColour::kMono) {
    image.format = MIEN_IMAGE_GRAY8;
    return image;
  }
  image.format = MIEN_IMAGE_I420;
  const auto chroma_width = static_cast<int>(header.chroma_width());
  const auto chroma_height = static_cast<int>(header.chroma_height());
  const int rows_apart = header.colour == formats::Y4mColour::k420 ? 1 : 2;
  image.chroma_pixel_stride_bytes = header.colour == formats::Y4mColour::k444 ? 2 : 1;
  const std::byte* chroma = frame + std::ptrdiff_t{width} * height;
  for (int plane = 1; plane <= 2; ++plane) {
    image.planes[plane] = chroma;
    image.row_stride_bytes[plane] = chroma_width * rows_apart;
    chroma += std::ptrdiff_t{chroma_width} * chroma_height;
  }
  return image;
}

bool is_y4m(const std::string& input) {
  return input == kStandardInput || (input.ends_with(".y4m") && !is_url(input));
}

std::string y4m_refusal(const std::string& path) {
  const InputFile file = open_input_file(path);
  if (!can_be_read_again(path)) {
    return {};
  }
  formats::Y4mReader reader;
  const formats::Y4mStatus status = reader.open(formats::file_source(file.get()));
  return status == formats::Y4mStatus::kOk ? std::string() : formats::message(status);
}

std::unique_ptr<VideoSource> open_y4m(const std::string& input, const InputOptions& options) {
  return std::make_unique<Y4mSource>(input, options);
}

}  // namespace mien::app
