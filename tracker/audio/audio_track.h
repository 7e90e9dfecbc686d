// The audio side of a tracker: audio blocks in, predicted controls and voice activity per frame
// out.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "audio/audio_pipeline.h"
#include "engine/arena.h"
#include "tracker/audio/audio_queue.h"
#include "tracker/audio/mixer.h"
#include "tracker/encoders/models.h"

namespace mien::tracker {

class AudioTrack {
 public:
  // Takes an audio track with its networks from `arena`; `track` is nullptr if the arena only
  // measures.
  [[nodiscard]] static mien_status load(const Models& models, const mien_tracker_config& config,
                                        engine::Arena& arena, AudioTrack*& track);

  // Returns to the state after creation, including offset and mixing weights.
  void reset();

  [[nodiscard]] mien_status push(const mien_audio* audio, std::int64_t pts_ns);

  // Another thread than that of the other functions may call `queue`; process_queued processes its
  // audio.
  [[nodiscard]] mien_status queue(const mien_audio* audio, std::int64_t pts_ns);
  [[nodiscard]] bool has_queued() const;
  void process_queued();

  // Added to the timestamps of audio.
  void set_offset(std::int64_t offset_ns) { offset_ns_ = offset_ns; }
  [[nodiscard]] Mixer& mixer() { return mixer_; }
  [[nodiscard]] const Mixer& mixer() const { return mixer_; }

  // Computes the output of the frame at pts_ns, `seconds` after the previous frame.
  void advance(std::int64_t pts_ns, float seconds);
  [[nodiscard]] const AudioOutput& output() const { return output_; }

  // Whether any audio was processed since the last reset.
  [[nodiscard]] bool has_audio() const { return has_audio_; }

 private:
  explicit AudioTrack(const mien_tracker_config& config) : config_(config) {}

  void process(const audio::Pcm& samples, std::int32_t rate, std::int64_t pts_ns);
  void clear_queue();

  const mien_tracker_config& config_;
  AudioQueue queue_;
  audio::AudioPipeline pipeline_;
  Mixer mixer_;
  std::int64_t offset_ns_ = 0;
  bool has_audio_ = false;
  AudioOutput output_;
};

}  // namespace mien::tracker
