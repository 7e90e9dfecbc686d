// Validates the caller's audio blocks.
#include "tracker/audio/audio_view.h"

#include <algorithm>
#include <iterator>

#include "audio/resampler.h"
#include "tracker/api/versioned_struct.h"

namespace mien::tracker {
namespace {

static_assert(MIEN_MAX_AUDIO_CHANNELS == audio::kMaxChannels);

bool is_aligned(const void* samples, std::int32_t format) {
  const std::uintptr_t size = format == MIEN_SAMPLES_INT16 ? sizeof(std::int16_t) : sizeof(float);
  return reinterpret_cast<std::uintptr_t>(samples) % size == 0;
}

mien_status check_samples(const mien_audio& audio) {
  const std::int32_t used = audio.planar != 0 ? audio.channels : 1;
  for (std::int32_t i = 0; audio.frames > 0 && i < used; ++i) {
    if (audio.samples[i] == nullptr) {
      return MIEN_ERROR_AUDIO_SAMPLES;
    }
    if (!is_aligned(audio.samples[i], audio.format)) {
      return MIEN_ERROR_ALIGNMENT;
    }
  }
  return MIEN_OK;
}

mien_status check(const mien_audio& audio) {
  if (audio.format != MIEN_SAMPLES_FLOAT32 && audio.format != MIEN_SAMPLES_INT16) {
    return MIEN_ERROR_AUDIO_FORMAT;
  }
  if (audio.sample_rate < audio::Resampler::kMinRate ||
      audio.sample_rate > audio::Resampler::kMaxRate) {
    return MIEN_ERROR_AUDIO_RATE;
  }
  if (audio.channels < 1 || audio.channels > MIEN_MAX_AUDIO_CHANNELS) {
    return MIEN_ERROR_AUDIO_CHANNELS;
  }
  return check_samples(audio);
}

}  // namespace

mien_status view_audio(const mien_audio* given, AudioView& view) {
  if (given == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  mien_audio audio;
  mien_audio_default(&audio);
  if (!read_struct(*given, MIEN_SIZE_THROUGH(mien_audio, samples), audio)) {
    return MIEN_ERROR_STRUCT_SIZE;
  }
  const mien_status status = check(audio);
  if (status != MIEN_OK) {
    return status;
  }
  view.rate = audio.sample_rate;
  view.pcm.format = audio.format == MIEN_SAMPLES_INT16 ? audio::SampleFormat::kInt16
                                                       : audio::SampleFormat::kFloat32;
  view.pcm.planar = audio.planar != 0;
  view.pcm.channels = audio.channels;
  view.pcm.frames = audio.frames;
  std::copy(std::begin(audio.samples), std::end(audio.samples), std::begin(view.pcm.channel));
  return MIEN_OK;
}

}  // namespace mien::tracker
