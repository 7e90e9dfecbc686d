// Simulates audio and video devices for the soak test.
#include "tests/tracker/soak.h"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "tests/tracker/blob_tracker.h"
#include "tests/tracker/times.h"

namespace mien::tests {
namespace {

constexpr double kFrameSeconds = 1.0 / 30.0;
constexpr double kBurstPeriod = 1.37;  // not a multiple of a frame, block or window
constexpr double kBurstReach = 0.3;    // seconds on each side of its centre
constexpr double kBlockSeconds = 0.01;
constexpr double kStepSeconds = 0.016;
constexpr std::array<std::int32_t, 4> kRates = {48000, 44100, 16000, 8000};

std::size_t resident_bytes() {
  long total = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &total, &resident) != 2) {
      resident = 0;
    }
    std::fclose(file);
  }
  return static_cast<std::size_t>(resident) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// CPU time of the thread, which does not include other programs.
double processor_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

std::int64_t ns(double seconds) { return std::llround(seconds * 1e9); }

double middle_of_burst(std::int64_t burst) {
  return (static_cast<double>(burst) + 0.5) * kBurstPeriod;
}

// Noise whose level rises and falls linearly in decibels, so that its loudness is a symmetric peak.
class BurstNoise {
 public:
  explicit BurstNoise(unsigned seed) : engine_(seed) {}

  float at(double seconds) {
    const double middle =
        middle_of_burst(static_cast<std::int64_t>(std::floor(seconds / kBurstPeriod)));
    const double distance = std::abs(seconds - middle) / kBurstReach;
    if (distance >= 1.0) {
      return 0.0f;
    }
    return noise_(engine_) * static_cast<float>(std::exp(-1.0 - 8.0 * distance));
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<float> noise_{-1.0f, 1.0f};
};

// A microphone that delivers consecutive blocks on its own clock.
class Microphone {
 public:
  Microphone(const SoakPlan& plan, BlobTracker& blob)
      : plan_(plan), blob_(blob), engine_(plan.seed), noise_(plan.seed + 1) {}

  // Pushes all blocks that end before `seconds`.
  void record_until(double seconds) {
    while (now_ + kBlockSeconds < seconds) {
      block();
    }
  }

  [[nodiscard]] double recorded_s() const { return recorded_s_; }
  [[nodiscard]] double disturbed_at() const { return disturbed_at_; }
  [[nodiscard]] int gaps() const { return gaps_; }
  [[nodiscard]] int rate_changes() const { return rate_changes_; }

 private:
  void block() {
    inject_faults();
    const std::int32_t rate = kRates[rate_];
    const double per_sample = 1.0 / (rate * (1.0 + plan_.skew));
    samples_.resize(static_cast<std::size_t>(kBlockSeconds * rate));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      samples_[i] = noise_.at(now_ + static_cast<double>(i) * per_sample);
    }
    Audio audio;
    audio.sample_rate = rate;
    audio.frames = samples_.size();
    audio.samples[0] = samples_.data();
    const double jitter = plan_.jitter_s * uniform(-1.0, 1.0);
    EXPECT_EQ(blob_.tracker().push_audio(audio, ns(now_ + jitter)), MIEN_OK);
    now_ += static_cast<double>(samples_.size()) * per_sample;
    recorded_s_ += kBlockSeconds;
  }

  void inject_faults() {
    if (now_ > next_gap_) {
      const double lost = std::exp(uniform(std::log(0.03), std::log(3.0)));
      now_ += lost;
      disturbed_at_ = now_;
      next_gap_ = now_ + plan_.seconds_between_gaps * uniform(0.5, 1.5);
      ++gaps_;
    }
    if (now_ > next_rate_) {
      rate_ = (rate_ + 1 + engine_() % (kRates.size() - 1)) % kRates.size();
      disturbed_at_ = now_;
      next_rate_ = now_ + plan_.seconds_between_rates * uniform(0.5, 1.5);
      ++rate_changes_;
    }
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  const SoakPlan& plan_;
  BlobTracker& blob_;
  std::mt19937 engine_;
  BurstNoise noise_;
  std::vector<float> samples_;
  double now_ = 0.0;
  double recorded_s_ = 0.0;
  std::size_t rate_ = 0;
  double disturbed_at_ = -1.0;
  double next_gap_ = 20.0;
  double next_rate_ = 60.0;
  int gaps_ = 0;
  int rate_changes_ = 0;
};

// Measures at which time the centre of each burst appears.
class BurstMeter {
 public:
  explicit BurstMeter(SoakReport& report) : report_(report) {}

  void frame(double seconds, float activity, double disturbed_at) {
    const auto burst = static_cast<std::int64_t>(std::floor(seconds / kBurstPeriod));
    if (burst != burst_) {
      finish(disturbed_at);
      burst_ = burst;
    }
    weight_ += activity;
    moment_ += static_cast<double>(activity) * (seconds - middle_of_burst(burst));
  }

 private:
  void finish(double disturbed_at) {
    const double begin = static_cast<double>(burst_) * kBurstPeriod;
    if (burst_ >= 0 && disturbed_at < begin - 1.0) {
      const double error_ms = 1000.0 * moment_ / weight_;
      ++report_.bursts;
      report_.mean_error_ms += (error_ms - report_.mean_error_ms) / report_.bursts;
      report_.max_error_ms = std::max(report_.max_error_ms, std::abs(error_ms));
    }
    weight_ = moment_ = 0.0;
  }

  SoakReport& report_;
  std::int64_t burst_ = -1;
  double weight_ = 0.0;
  double moment_ = 0.0;
};

// Linear regression of points that are added one by one.
class Line {
 public:
  void add(double x, double y) {
    ++count_;
    const double from_mean = x - mean_x_;
    mean_x_ += from_mean / count_;
    mean_y_ += (y - mean_y_) / count_;
    squares_ += from_mean * (x - mean_x_);
    products_ += from_mean * (y - mean_y_);
  }
  [[nodiscard]] double slope() const { return squares_ > 0.0 ? products_ / squares_ : 0.0; }

 private:
  double count_ = 0.0, mean_x_ = 0.0, mean_y_ = 0.0, squares_ = 0.0, products_ = 0.0;
};

bool is_valid(const Result& result) {
  const auto unit = [](float value) { return value >= 0.0f && value <= 1.0f; };
  const auto finite = [](float value) { return std::isfinite(value); };
  const float* landmarks = &result.landmarks[0][0];
  return unit(result.face_probability) && unit(result.voice_activity) &&
         std::all_of(result.controls, result.controls + MIEN_CONTROL_COUNT, unit) &&
         std::all_of(result.box, result.translation + 3, finite) &&
         std::all_of(landmarks, landmarks + sizeof result.landmarks / sizeof(float), finite);
}

}  // namespace

SoakReport soak(const SoakPlan& plan) {
  BlobTracker blob({}, [](mien_tracker_config& config) {
    config.lod = 1;
    config.voice_attack_ms = config.voice_release_ms = 0.0f;
  });
  const Buffer face(disc_picture(64.0f, 48.0f, 35.0f, 128, 96), {.format = MIEN_IMAGE_GRAY8});
  const Buffer nothing(Picture(128, 96), {.format = MIEN_IMAGE_GRAY8});
  Microphone microphone(plan, blob);
  SoakReport report;
  BurstMeter meter(report);
  Times times;
  Line memory;
  const auto frames = static_cast<std::int64_t>(plan.seconds / kFrameSeconds);
  const std::int64_t settled = frames / 10,
                     sample_interval = std::max<std::int64_t>(frames / 500, 1);
  for (; report.frames < frames; ++report.frames) {
    const double seconds = static_cast<double>(report.frames) * kFrameSeconds;
    microphone.record_until(seconds + 0.1);
    const bool is_hidden = report.frames % 3000 < 120;
    const mien_image& image = (is_hidden ? nothing : face).image();
    const double began_us = processor_us();
    const mien_status pushed = blob.tracker().push_video(image, ns(seconds));
    const double took_us = processor_us() - began_us;
    EXPECT_EQ(pushed, MIEN_OK);
    const Result result = blob.result();
    meter.frame(seconds, result.voice_activity, microphone.disturbed_at());
    report.invalid_results += is_valid(result) ? 0 : 1;
    report.faces_found += (result.flags & MIEN_RESULT_FOUND) != 0 ? 1 : 0;
    report.last_face_id = std::max(report.last_face_id, result.face_id);
    report.frames_with_face = static_cast<std::int64_t>(result.face_frames);
    if (report.frames < settled) {
      continue;
    }
    times.add(took_us);
    if ((report.frames - settled) % sample_interval == 0) {
      const std::size_t resident = resident_bytes();
      report.resident_bytes_early =
          report.frames == settled ? resident : report.resident_bytes_early;
      memory.add(seconds / 3600.0, static_cast<double>(resident));
    }
  }
  report.resident_bytes_late = resident_bytes();
  report.memory_slope_bytes = memory.slope();
  report.median_us = times.percentile(0.5);
  report.p999_us = times.percentile(0.999);
  report.worst_us = times.worst();
  report.audio_steps = static_cast<std::int64_t>(microphone.recorded_s() / kStepSeconds);
  report.gaps = microphone.gaps();
  report.rate_changes = microphone.rate_changes();
  return report;
}

}  // namespace mien::tests
