// The voice of one tracker: sound in, over time, and out what is heard on each frame.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "audio/listener.h"
#include "engine/arena.h"
#include "tracker/encoders/models.h"
#include "tracker/sound/mixer.h"
#include "tracker/sound/sound_queue.h"

namespace mien::tracker {

class Voice {
 public:
  // Takes from `arena` a voice with its networks; `voice` is nullptr when the arena measures.
  [[nodiscard]] static mien_status load(const Models& models, const mien_tracker_config& config,
                                        engine::Arena& arena, Voice*& voice);

  // Forgets what was heard, and what was set since.
  void reset();

  [[nodiscard]] mien_status push(const mien_audio* sound, std::int64_t pts_ns);

  // By another thread than all else here, for `hear_queued`.
  [[nodiscard]] mien_status queue(const mien_audio* sound, std::int64_t pts_ns);
  [[nodiscard]] bool has_queued() const;
  void hear_queued();

  // Later than its timestamps by this much.
  void set_offset(std::int64_t offset_ns) { offset_ns_ = offset_ns; }
  [[nodiscard]] Mixer& mixer() { return mixer_; }
  [[nodiscard]] const Mixer& mixer() const { return mixer_; }

  // One frame of output at that time, `seconds` after the one before.
  void advance(std::int64_t pts_ns, float seconds);
  [[nodiscard]] const Heard& heard() const { return heard_; }

  // Whether any sound came since the beginning.
  [[nodiscard]] bool is_listening() const { return listening_; }

 private:
  explicit Voice(const mien_tracker_config& config) : config_(config) {}

  void hear(const audio::Pcm& samples, std::int32_t rate, std::int64_t pts_ns);
  void forget_queued();

  const mien_tracker_config& config_;
  SoundQueue queue_;
  audio::Listener listener_;
  Mixer mixer_;
  std::int64_t offset_ns_ = 0;
  bool listening_ = false;
  Heard heard_;
};

}  // namespace mien::tracker
