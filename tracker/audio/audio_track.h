// The voice of one tracker: sound in, over time, and out what is heard on each frame.
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
  // Takes from `arena` a voice with its networks; `voice` is nullptr when the arena measures.
  [[nodiscard]] static mien_status load(const Models& models, const mien_tracker_config& config,
                                        engine::Arena& arena, AudioTrack*& voice);

  // Forgets what was heard, and what was set since.
  void reset();

  [[nodiscard]] mien_status push(const mien_audio* sound, std::int64_t pts_ns);

  // By another thread than all else here, for `process_queued`.
  [[nodiscard]] mien_status queue(const mien_audio* sound, std::int64_t pts_ns);
  [[nodiscard]] bool has_queued() const;
  void process_queued();

  // Later than its timestamps by this much.
  void set_offset(std::int64_t offset_ns) { offset_ns_ = offset_ns; }
  [[nodiscard]] Mixer& mixer() { return mixer_; }
  [[nodiscard]] const Mixer& mixer() const { return mixer_; }

  // One frame of output at that time, `seconds` after the one before.
  void advance(std::int64_t pts_ns, float seconds);
  [[nodiscard]] const AudioOutput& output() const { return output_; }

  // Whether any sound came since the beginning.
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
