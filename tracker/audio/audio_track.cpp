// The audio track of a tracker.
#include "tracker/audio/audio_track.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <type_traits>

#include "audio/timestamps.h"
#include "tracker/audio/audio_view.h"
#include "tracker/decoders/smoothing.h"

namespace mien::tracker {
namespace {

constexpr std::size_t kJawOpen = control_named("jawOpen");
constexpr std::size_t kMouthClose = control_named("mouthClose");

// Maps audio::Speech::controls to the 52 controls.
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

Controls all_controls(const audio::Speech& speech, float strength) {
  Controls controls = {};
  for (std::size_t i = 0; i < kSpeechControls.size(); ++i) {
    controls[kSpeechControls[i]] = std::min(strength * speech.controls[i], 1.0f);
  }
  // mouthClose cancels the opening by jawOpen; a larger value would push the lips into each other.
  controls[kMouthClose] = std::min(controls[kMouthClose], controls[kJawOpen]);
  return controls;
}

constexpr float kMinAlpha = 1e-6f;  // below it alpha is 0

// Step of a first-order low-pass towards its input, as a fraction of their distance.
float low_pass_coefficient(float seconds, float time_constant_ms) {
  return time_constant_ms > 0.0f ? 1.0f - std::exp(-1000.0f * seconds / time_constant_ms) : 1.0f;
}

}  // namespace

mien_status AudioTrack::load(const Models& models, const mien_tracker_config& config,
                             engine::Arena& arena, AudioTrack*& track) {
  static_assert(std::is_trivially_destructible_v<AudioTrack>, "the arena destroys nothing");
  static_assert(alignof(AudioTrack) <= engine::Arena::kAlignment);
  const std::span<std::byte> memory = arena.take(sizeof(AudioTrack));
  track = memory.empty() ? nullptr : new (memory.data()) AudioTrack(config);
  AudioQueue measured;
  (track != nullptr ? track->queue_ : measured).load(config.audio_queue_samples, arena);
  audio::AudioNet net;
  mien_status status = net.load(models.audionet, config.cpu_mask, arena);
  Mixer mixer;
  if (status == MIEN_OK) {
    status = mixer.load(models.audionet);
  }
  if (status != MIEN_OK || track == nullptr) {
    return status;
  }
  track->mixer_ = mixer;
  return track->pipeline_.init(net, config.cpu_mask) ? MIEN_OK : MIEN_ERROR_UNSUPPORTED_CPU;
}

void AudioTrack::reset() {
  clear_queue();
  pipeline_.reset();
  mixer_.restore();
  offset_ns_ = 0;
  has_audio_ = false;
  output_ = {};
}

mien_status AudioTrack::push(const mien_audio* audio, std::int64_t pts_ns) {
  AudioView view;
  const mien_status status = view_audio(audio, view);
  if (status != MIEN_OK) {
    return status;
  }
  process(view.pcm, view.rate, pts_ns);
  return MIEN_OK;
}

void AudioTrack::process(const audio::Pcm& samples, std::int32_t rate, std::int64_t pts_ns) {
  pipeline_.push(samples, rate, audio::later(pts_ns, offset_ns_));
  has_audio_ = has_audio_ || samples.frames > 0;
}

mien_status AudioTrack::queue(const mien_audio* audio, std::int64_t pts_ns) {
  AudioView view;
  const mien_status status = view_audio(audio, view);
  if (status != MIEN_OK) {
    return status;
  }
  return queue_.push(view, pts_ns) ? MIEN_OK : MIEN_ERROR_AUDIO_QUEUE_FULL;
}

bool AudioTrack::has_queued() const { return !queue_.empty(); }

void AudioTrack::process_queued() {
  AudioQueue::Block block;
  audio::Pcm samples;
  while (queue_.front(block, samples)) {
    process(samples, block.rate, block.pts_ns);
    queue_.pop(block);
  }
}

void AudioTrack::clear_queue() {
  AudioQueue::Block block;
  audio::Pcm samples;
  while (queue_.front(block, samples)) {
    queue_.pop(block);
  }
}

void AudioTrack::advance(std::int64_t pts_ns, float seconds) {
  const audio::Speech speech = pipeline_.at(pts_ns);
  const Controls controls = all_controls(speech, config_.voice_strength);
  if (config_.smoothing == 0 || output_.alpha == 0.0f) {
    output_.controls = controls;
  } else {
    smooth_controls(controls, seconds, output_.controls);
  }
  const float time_constant_ms =
      speech.activity > output_.alpha ? config_.voice_attack_ms : config_.voice_release_ms;
  output_.alpha +=
      low_pass_coefficient(seconds, time_constant_ms) * (speech.activity - output_.alpha);
  output_.alpha = output_.alpha < kMinAlpha ? 0.0f : output_.alpha;
}

}  // namespace mien::tracker
