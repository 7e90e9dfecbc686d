// Audio decoded by ffmpeg: one channel at 16 kHz.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/decoder.h"

namespace mien::app {

class DecodedAudio : public AudioSource {
 public:
  // `stream`: index in the output of the decoder.
  DecodedAudio(std::string input, const VideoRange& range, std::shared_ptr<Decoder> decoder,
               std::size_t stream);  // 0: the decoder has no other stream

  bool next(Audio& block, std::int64_t& pts_ns) override;
  // A decoder of video and audio reports its errors as those of the video.
  [[nodiscard]] Damage damage() const override {
    return stream_ == 0 ? decoder_->damage() : Damage();
  }

 private:
  void at_end() const;
  void convert(std::size_t first, std::size_t last);

  std::string input_;
  VideoRange range_;
  std::shared_ptr<Decoder> decoder_;
  std::size_t stream_;
  NutPacket packet_;
  std::vector<float> samples_;
  bool has_output_ = false;
};

}  // namespace mien::app
