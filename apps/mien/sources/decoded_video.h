// Video decoded by ffmpeg: upright RGB images with square pixels and their own timestamps.
#pragma once

#include <memory>
#include <string>

#include "apps/mien/sources/decoder.h"
#include "apps/mien/sources/video_source.h"

namespace mien::app {

class DecodedVideo : public VideoSource {
 public:
  // `stream`: index in the output of the decoder.
  DecodedVideo(std::string input, const VideoRange& range, const VideoInfo& info,
               std::shared_ptr<Decoder> decoder, std::size_t stream);

  const VideoInfo& info() const override { return info_; }
  bool next(mien_image& image, std::int64_t& pts_ns) override;
  [[nodiscard]] Damage damage() const override { return decoder_->damage(); }

 private:
  bool next_in_range(std::int64_t& pts_ns);
  void at_end() const;

  std::string input_;
  VideoRange range_;
  VideoInfo info_;
  std::shared_ptr<Decoder> decoder_;
  std::size_t stream_;
  NutPacket packet_;
  std::int64_t frames_ = 0;
};

}  // namespace mien::app
