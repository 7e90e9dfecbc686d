// Measures audio processing in blocks of 16 ms.
#include "apps/mien/bench/audio_bench.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kStepNs = 16'000'000;
constexpr int kSteps = 4000;

// One block of 16 ms: resampler, features, encoder, both decoders.
struct AudioTime {
  std::int32_t rate;
  double min_us, median_us, p95_us;
};

AudioTime time_audio(Tracker& tracker, std::int32_t rate) {
  std::mt19937 engine(1);
  std::normal_distribution<float> noise(0.0f, 0.1f);
  std::vector<float> samples(static_cast<std::size_t>(rate * kStepNs / 1'000'000'000));
  std::vector<double> us;
  check(tracker.reset(), "bench");
  for (int step = 0; step < kSteps; ++step) {
    for (float& sample : samples) {
      sample = noise(engine);
    }
    Audio audio;
    audio.sample_rate = rate;
    audio.frames = samples.size();
    audio.samples[0] = samples.data();
    const auto begin = Clock::now();
    const mien_status status = tracker.push_audio(audio, step * kStepNs);
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    check(status, "bench");
  }
  std::sort(us.begin(), us.end());
  return {rate, us.front(), us[us.size() / 2], us[us.size() * 95 / 100]};
}

}  // namespace

void bench_audio(const BenchOptions& options) {
  LoadedTracker loaded({.models = options.models, .tier = options.tier, .sound = true});
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::int32_t rate : {16000, 44100, 48000}) {
    const AudioTime time = time_audio(loaded.tracker, rate);
    json.push_back({{"sample_rate", time.rate},
                    {"min_us", time.min_us},
                    {"median_us", time.median_us},
                    {"p95_us", time.p95_us}});
    if (!options.json) {
      std::printf("16 ms at %6d Hz: min %7.1f us  median %7.1f us  p95 %7.1f us\n", rate,
                  time.min_us, time.median_us, time.p95_us);
    }
  }
  if (options.json) {
    std::printf("%s\n", json.dump(1).c_str());
  }
}

}  // namespace mien::app
