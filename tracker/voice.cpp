#include "tracker/voice.h"

#include <cmath>
#include <new>
#include <type_traits>

#include "audio/timestamps.h"
#include "tracker/smoothing.h"
#include "tracker/sound_view.h"

namespace mien::tracker {
namespace {

// Of audio::Speech::controls among the 52.
constexpr std::array<std::size_t, audio::kSpeechControls> kSpeechControls = {
    control_named("jawOpen"),
    control_named("jawForward"),
    control_named("mouthClose"),
    control_named("mouthFunnel"),
    control_named("mouthPucker"),
    control_named("mouthRollLower"),
    control_named("mouthRollUpper"),
    control_named("mouthShrugLower"),
    control_named("mouthShrugUpper"),
    control_named("mouthPressLeft"),
    control_named("mouthPressRight"),
    control_named("mouthStretchLeft"),
    control_named("mouthStretchRight"),
    control_named("mouthLowerDownLeft"),
    control_named("mouthLowerDownRight"),
    control_named("mouthUpperUpLeft"),
    control_named("mouthUpperUpRight"),
    control_named("tongueOut"),
};

Controls among_all(const audio::Speech& speech) {
  Controls controls = {};
  for (std::size_t i = 0; i < kSpeechControls.size(); ++i) {
    controls[kSpeechControls[i]] = speech.controls[i];
  }
  return controls;
}

constexpr float kNothing = 1e-6f;

// Share of the way that a first-order low-pass goes.
float share(float seconds, float constant_ms) {
  return constant_ms > 0.0f ? 1.0f - std::exp(-1000.0f * seconds / constant_ms) : 1.0f;
}

}  // namespace

mien_status Voice::load(const Models& models, const mien_tracker_config& config,
                        engine::Arena& arena, Voice*& voice) {
  static_assert(std::is_trivially_destructible_v<Voice>, "the arena destroys nothing");
  static_assert(alignof(Voice) <= engine::Arena::kAlignment);
  const std::span<std::byte> room = arena.take(sizeof(Voice));
  audio::AudioNet net;
  mien_status status = net.load(models.audionet, config.cpu_mask, arena);
  Mixer mixer;
  if (status == MIEN_OK) {
    status = mixer.load(models.audionet);
  }
  voice = nullptr;
  if (status != MIEN_OK || arena.measuring()) {
    return status;
  }
  voice = new (room.data()) Voice(config);
  voice->mixer_ = mixer;
  return voice->listener_.init(net, config.cpu_mask) ? MIEN_OK : MIEN_ERROR_UNSUPPORTED_CPU;
}

void Voice::reset() {
  listener_.reset();
  mixer_.restore();
  offset_ns_ = 0;
  listening_ = false;
  heard_ = {};
}

mien_status Voice::push(const mien_audio* sound, std::int64_t pts_ns) {
  SoundView view;
  const mien_status status = view_sound(sound, view);
  if (status != MIEN_OK) {
    return status;
  }
  listener_.push(view.pcm, view.rate, audio::later(pts_ns, offset_ns_));
  listening_ = true;
  return MIEN_OK;
}

void Voice::advance(std::int64_t pts_ns, float seconds) {
  const audio::Speech speech = listener_.at(pts_ns);
  const Controls controls = among_all(speech);
  if (config_.smoothing == 0 || heard_.alpha == 0.0f) {
    heard_.controls = controls;
  } else {
    smooth_controls(controls, seconds, heard_.controls);
  }
  const float constant_ms =
      speech.activity > heard_.alpha ? config_.voice_attack_ms : config_.voice_release_ms;
  heard_.alpha += share(seconds, constant_ms) * (speech.activity - heard_.alpha);
  heard_.alpha = heard_.alpha < kNothing ? 0.0f : heard_.alpha;
}

}  // namespace mien::tracker
