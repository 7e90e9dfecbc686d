#include "audio/audio_pipeline.h"

#include <algorithm>

#include "audio/timestamps.h"

namespace mien::audio {
namespace {

constexpr std::size_t kBlock = 256;  // samples turned to mono at once

Speech between(const Speech& a, const Speech& b, float share) {
  Speech mixed;
  std::transform(a.controls.begin(), a.controls.end(), b.controls.begin(), mixed.controls.begin(),
                 [share](float x, float y) { return x + share * (y - x); });
  mixed.activity = a.activity + share * (b.activity - a.activity);
  return mixed;
}

}  // namespace

bool AudioPipeline::init(const AudioNet& net, std::uint32_t cpu_mask) {
  net_ = net;
  return front_end_.init(cpu_mask);
}

void AudioPipeline::reset() {
  rate_ = 0;  // another than any, so that clock and network begin anew with the first sound
  known_ = 0;
}

void AudioPipeline::push(const Pcm& sound, std::int32_t rate, std::int64_t pts_ns) {
  if (sound.frames == 0) {
    return;
  }
  const bool same_rate = rate == rate_;
  if (!same_rate) {
    clock_.restart();
  }
  follow(clock_.advance(pts_ns, sound.frames, rate), rate);
  std::array<float, kBlock> mono;
  for (std::size_t first = 0; first < sound.frames; first += kBlock) {
    std::span<const float> block = std::span(mono).first(std::min(kBlock, sound.frames - first));
    to_mono(sound, first, std::span(mono).first(block.size()));
    while (!block.empty()) {
      block = block.subspan(front_end_.take(block));
      process();
    }
  }
}

// Sound of another rate goes on as the same voice; after a break it is another one.
void AudioPipeline::follow(AudioClock::Flow flow, std::int32_t rate) {
  if (flow != AudioClock::Flow::kBreak) {
    return;
  }
  const bool goes_on = rate_ != 0 && rate != rate_;
  rate_ = rate;
  stream_steps_ = 0;
  front_end_.start(rate);
  if (!goes_on) {
    net_.reset();
  }
}

void AudioPipeline::process() {
  std::array<float, FrontEnd::kFeatures> features;
  while (front_end_.fetch(features)) {
    const std::int64_t time = clock_.time_ns(FrontEnd::seconds_of_step(stream_steps_));
    ++stream_steps_;
    remember({time, net_.process(features)});
  }
}

const AudioPipeline::Moment& AudioPipeline::moment(std::size_t back) const {
  return moments_[(next_ + kRememberedSteps - 1 - back) % kRememberedSteps];
}

// Where time has hopped back, what was heard last counts.
void AudioPipeline::remember(const Moment& heard) {
  while (known_ > 0 && from_to(moment(0).time_ns, heard.time_ns) <= 0) {
    next_ = (next_ + kRememberedSteps - 1) % kRememberedSteps;
    --known_;
  }
  moments_[next_] = heard;
  next_ = (next_ + 1) % kRememberedSteps;
  known_ = std::min(known_ + 1, kRememberedSteps);
}

Speech AudioPipeline::at(std::int64_t time_ns) const {
  std::size_t back = 0;
  while (back < known_ && from_to(moment(back).time_ns, time_ns) < 0) {
    ++back;
  }
  if (back == known_) {
    return {};
  }
  const Moment& before = moment(back);
  const std::int64_t since = from_to(before.time_ns, time_ns);
  const Moment& after = moment(back > 0 ? back - 1 : 0);
  const std::int64_t apart = from_to(before.time_ns, after.time_ns);
  if (back == 0 || apart > kPatienceNs) {
    return since <= kPatienceNs ? before.speech : Speech{before.speech.controls, 0.0f};
  }
  return between(before.speech, after.speech,
                 static_cast<float>(static_cast<double>(since) / static_cast<double>(apart)));
}

}  // namespace mien::audio
