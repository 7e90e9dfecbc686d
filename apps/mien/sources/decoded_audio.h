// Sound that ffmpeg decodes: one channel of 16 kHz.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/decoder.h"

namespace mien::app {

class DecodedAudio : public AudioSource {
 public:
  // `stream`: its number in what the decoder writes.
  DecodedAudio(std::string input, const VideoRange& range, std::shared_ptr<Decoder> decoder,
               std::size_t stream);  // of 0 the decoder is this one's own

  bool next(Audio& block, std::int64_t& pts_ns) override;
  // What a decoder of both complains of is the video's.
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
  bool heard_ = false;
};

}  // namespace mien::app
