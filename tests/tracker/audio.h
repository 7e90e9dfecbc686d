// Reproducible audio for tests.
#pragma once

#include <mien/mien.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace mien::tests {

// A reproducible sequence of noise and silence.
class TestAudio {
 public:
  explicit TestAudio(int rate = 16000) : rate_(rate) {}

  TestAudio& add(double seconds, float amplitude) {
    std::uniform_real_distribution<float> noise(-amplitude, amplitude);
    const auto count = static_cast<std::size_t>(std::llround(seconds * rate_));
    for (std::size_t i = 0; i < count; ++i) {
      samples_.push_back(amplitude > 0.0f ? noise(engine_) : 0.0f);
    }
    return *this;
  }

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] Audio block(std::size_t first, std::size_t count) const {
    Audio audio;
    audio.sample_rate = rate_;
    audio.frames = std::min(count, samples_.size() - first);
    audio.samples[0] = samples_.data() + first;
    return audio;
  }
  [[nodiscard]] Audio all() const { return block(0, samples_.size()); }
  [[nodiscard]] std::int64_t time_ns(std::size_t sample) const {
    return static_cast<std::int64_t>(sample) * 1'000'000'000 / rate_;
  }

 private:
  int rate_;
  std::mt19937 engine_{3};
  std::vector<float> samples_;
};

}  // namespace mien::tests
