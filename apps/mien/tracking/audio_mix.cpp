// Reads the weights of the mixture and applies them.
#include "apps/mien/tracking/audio_mix.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "apps/mien/system/failure.h"
#include "formats/bundle.h"
#include "formats/mien_file.h"

namespace mien::app {
namespace {

using Weights = std::array<float, MIEN_CONTROL_COUNT>;

Weights read(const formats::FileView& file, std::string_view name) {
  const formats::TensorRecord* tensor = file.find_constant(name);
  Weights weights;
  if (tensor == nullptr || tensor->bytes != sizeof weights) {
    throw Failure(kExitModel, "audionet.mien: no constant " + std::string(name));
  }
  std::memcpy(weights.data(), file.data(*tensor).data(), sizeof weights);
  return weights;
}

}  // namespace

AudioMix::AudioMix(const Blob& audionet) {
  if (formats::is_packed(audionet.bytes())) {
    *this = AudioMix(Blob::unpacked(audionet));
    return;
  }
  formats::FileView file;
  if (formats::open(audionet.bytes(), file).status != MIEN_OK) {
    throw Failure(kExitModel, "audionet.mien: cannot be read");
  }
  audio_ = read(file, "mix_audio");
  video_ = read(file, "mix_video");
}

std::array<float, MIEN_CONTROL_COUNT> AudioMix::controls(const Result& from_video,
                                                         const Result& from_audio,
                                                         const Weights& fading) const {
  Weights mixed;
  const float alpha = from_audio.voice_activity;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    const float video = from_video.controls[i];
    if (!from_video.supports(static_cast<std::int32_t>(i))) {
      mixed[i] = from_audio.controls[i];
    } else if (audio_[i] <= 0.0f) {
      mixed[i] = video;
    } else {
      // Without a face the tracker outputs (1 - alpha) * fading + alpha * prediction from audio.
      const float spoken = std::max(from_audio.controls[i] - (1.0f - alpha) * fading[i], 0.0f);
      mixed[i] =
          std::clamp((1.0f - alpha + alpha * video_[i]) * video + audio_[i] * spoken, 0.0f, 1.0f);
    }
  }
  return mixed;
}

}  // namespace mien::app
