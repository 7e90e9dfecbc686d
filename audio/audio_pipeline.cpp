// Runs audio blocks through the front end and AudioNet, and interpolates the predictions.
#include "audio/audio_pipeline.h"

#include <algorithm>

#include "audio/timestamps.h"

namespace mien::audio {
namespace {

constexpr std::size_t kBlock = 256;  // samples converted to mono at a time

Speech interpolate(const Speech& a, const Speech& b, float weight) {
  Speech mixed;
  std::transform(a.controls.begin(), a.controls.end(), b.controls.begin(), mixed.controls.begin(),
                 [weight](float x, float y) { return x + weight * (y - x); });
  mixed.activity = a.activity + weight * (b.activity - a.activity);
  return mixed;
}

}  // namespace

bool AudioPipeline::init(const AudioNet& net, std::uint32_t cpu_mask) {
  net_ = net;
  return front_end_.init(cpu_mask);
}

void AudioPipeline::reset() {
  rate_ = 0;  // not a valid rate, so that the next block resets clock and network
  count_ = 0;
}

void AudioPipeline::push(const Pcm& pcm, std::int32_t rate, std::int64_t pts_ns) {
  if (pcm.frames == 0) {
    return;
  }
  const bool same_rate = rate == rate_;
  if (!same_rate) {
    clock_.restart();
  }
  start_stream_if_broken(clock_.advance(pts_ns, pcm.frames, rate), rate);
  std::array<float, kBlock> mono;
  for (std::size_t first = 0; first < pcm.frames; first += kBlock) {
    std::span<const float> block = std::span(mono).first(std::min(kBlock, pcm.frames - first));
    to_mono(pcm, first, std::span(mono).first(block.size()));
    while (!block.empty()) {
      block = block.subspan(front_end_.take(block));
      process();
    }
  }
}

// A change of the rate keeps the network's state; any other break resets it.
void AudioPipeline::start_stream_if_broken(AudioClock::Flow flow, std::int32_t rate) {
  if (flow != AudioClock::Flow::kBreak) {
    return;
  }
  const bool only_rate_changed = rate_ != 0 && rate != rate_;
  rate_ = rate;
  stream_steps_ = 0;
  front_end_.start(rate);
  if (!only_rate_changed) {
    net_.reset();
  }
}

void AudioPipeline::process() {
  std::array<float, FrontEnd::kFeatures> features;
  while (front_end_.fetch(features)) {
    const std::int64_t time = clock_.time_ns(FrontEnd::seconds_of_step(stream_steps_));
    ++stream_steps_;
    store({time, net_.process(features, front_end_.log_mel())});
  }
}

const AudioPipeline::Prediction& AudioPipeline::stored(std::size_t back) const {
  return predictions_[(next_ + kStoredSteps - 1 - back) % kStoredSteps];
}

// After a jump back in time, the newest prediction replaces older ones of the same time.
void AudioPipeline::store(const Prediction& prediction) {
  while (count_ > 0 && from_to(stored(0).time_ns, prediction.time_ns) <= 0) {
    next_ = (next_ + kStoredSteps - 1) % kStoredSteps;
    --count_;
  }
  predictions_[next_] = prediction;
  next_ = (next_ + 1) % kStoredSteps;
  count_ = std::min(count_ + 1, kStoredSteps);
}

Speech AudioPipeline::at(std::int64_t time_ns) const {
  std::size_t back = 0;
  while (back < count_ && from_to(stored(back).time_ns, time_ns) < 0) {
    ++back;
  }
  if (back == count_) {
    return {};
  }
  const Prediction& before = stored(back);
  const std::int64_t since = from_to(before.time_ns, time_ns);
  const Prediction& after = stored(back > 0 ? back - 1 : 0);
  const std::int64_t interval = from_to(before.time_ns, after.time_ns);
  if (back == 0 || interval > kMaxHoldNs) {
    return since <= kMaxHoldNs ? before.speech : Speech{before.speech.controls, 0.0f};
  }
  return interpolate(
      before.speech, after.speech,
      static_cast<float>(static_cast<double>(since) / static_cast<double>(interval)));
}

}  // namespace mien::audio
