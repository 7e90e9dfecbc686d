// Hours of audio and video, faster than real time, from simulated devices with faults.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::tests {

// Faults of the audio: a clock that differs by `skew`, jitter of timestamps, lost blocks, and
// changes of the sample rate.
struct SoakPlan {
  double seconds = 0.0;  // of audio and video
  double skew = 50e-6;
  double jitter_s = 0.003;
  double seconds_between_gaps = 41.0;
  double seconds_between_rates = 97.0;
  unsigned seed = 1;
};

struct SoakReport {
  std::int64_t frames = 0;
  int bursts = 0;  // of noise whose time was measured
  int gaps = 0;
  int rate_changes = 0;
  // Time between a burst and the frames that show it: mean, and largest absolute value.
  double mean_error_ms = 0.0;
  double max_error_ms = 0.0;
  std::int64_t frames_with_face = 0;
  std::int64_t audio_steps = 0;  // of AudioNet's 16 ms
  // Results with a number that is not finite or out of range.
  std::int64_t invalid_results = 0;
  // These are equal, because each face that returns gets the next id.
  std::uint32_t faces_found = 0;
  std::uint32_t last_face_id = 0;
  // Resident memory of the process, after a tenth of the time:
  std::size_t resident_bytes_early = 0;  // at its start
  std::size_t resident_bytes_late = 0;   // at the end
  double memory_slope_bytes = 0.0;       // per hour of audio and video, by least squares
  // Processor time of pushing an image, us.
  double median_us = 0.0;
  double p999_us = 0.0;
  double worst_us = 0.0;
};

// Bursts are not measured if audio was lost or the rate changed during them or within a second
// before.
SoakReport soak(const SoakPlan& plan);

}  // namespace mien::tests
