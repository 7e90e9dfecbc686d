#include "apps/mien/sources/y4m_source.h"

#include <cmath>
#include <cstdio>
#include <vector>

#include "apps/mien/system/failure.h"
#include "formats/y4m.h"

namespace mien::app {
namespace {

class Y4mSource : public VideoSource {
 public:
  Y4mSource(const std::string& input, const VideoRange& range);
  ~Y4mSource() override {
    if (file_ != stdin) {
      std::fclose(file_);
    }
  }
  Y4mSource(const Y4mSource&) = delete;
  Y4mSource& operator=(const Y4mSource&) = delete;

  const VideoInfo& info() const override { return info_; }
  bool next(mien_image& image, std::int64_t& pts_ns) override;

 private:
  bool read_frame();
  [[nodiscard]] double seconds(std::int64_t frame) const {
    return static_cast<double>(frame) / info_.fps;
  }

  std::string name_;
  VideoRange range_;
  std::FILE* file_;
  formats::Y4mReader reader_;
  VideoInfo info_;
  std::vector<std::byte> frame_;
  std::int64_t frames_ = 0;
};

Y4mSource::Y4mSource(const std::string& input, const VideoRange& range)
    : name_(input == "-" ? "standard input" : input),
      range_(range),
      file_(input == "-" ? stdin : std::fopen(input.c_str(), "rb")) {
  if (file_ == nullptr) {
    throw Failure(kExitNoInput, name_ + ": no such file");
  }
  const formats::Y4mStatus status = reader_.open(formats::file_source(file_));
  if (status != formats::Y4mStatus::kOk) {
    throw Failure(kExitNoVideo, name_ + ": not a Y4M video: " + formats::message(status));
  }
  const formats::Y4mHeader& header = reader_.header();
  info_.width = static_cast<int>(header.width);
  info_.height = static_cast<int>(header.height);
  info_.fps = static_cast<double>(header.rate_num) / static_cast<double>(header.rate_den);
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
  pts_ns = std::llround(seconds(frames_ - 1) * 1e9);
  return true;
}

}  // namespace

// 4:2:2 and 4:4:4 are read as 4:2:0 by stepping over the chroma samples in between.
mien_image y4m_image(const formats::Y4mHeader& header, const std::byte* frame) {
  const auto width = static_cast<int>(header.width), height = static_cast<int>(header.height);
  mien_image image;
  mien_image_default(&image);
  image.width = width;
  image.height = height;
  image.full_range = header.full_range ? 1 : 0;
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

std::unique_ptr<VideoSource> open_y4m(const std::string& input, const VideoRange& range) {
  return std::make_unique<Y4mSource>(input, range);
}

}  // namespace mien::app
