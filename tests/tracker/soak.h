// Hours of pictures and sound at once, faster than they pass, from devices that misbehave.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien::tests {

// What is wrong with the sound: its clock is off by `skew`, timestamps tremble, blocks get lost,
// and now and then the device comes back with another rate.
struct SoakPlan {
  double seconds = 0.0;  // of picture and sound
  double skew = 50e-6;
  double tremble_s = 0.003;
  double seconds_between_gaps = 41.0;
  double seconds_between_rates = 97.0;
  unsigned seed = 1;
};

struct SoakReport {
  std::int64_t frames = 0;
  int bursts = 0;  // of sound whose time was measured
  int gaps = 0;
  int rate_changes = 0;
  // Between a burst and the frames that show it: the mean, and the largest distance from 0.
  double mean_error_ms = 0.0;
  double largest_error_ms = 0.0;
  std::int64_t frames_with_face = 0;
  std::int64_t steps_of_sound = 0;  // of AudioNet's 16 ms
  // Results in which a number is not finite or out of its range.
  std::int64_t insane_results = 0;
  // Each face that comes back is the next one: these are equal.
  std::uint32_t faces_found = 0;
  std::uint32_t last_face_id = 0;
  // From a tenth of the time on. Of the process:
  std::size_t resident_bytes_early = 0;  // where that begins
  std::size_t resident_bytes_late = 0;   // at the end
  double memory_slope_bytes = 0.0;       // an hour of picture and sound, by least squares
  // Processor time of pushing an image, us.
  double median_us = 0.0;
  double p999_us = 0.0;
  double worst_us = 0.0;
};

// Bursts during which, or within a second before which, sound was lost or the rate changed are not
// measured.
SoakReport soak(const SoakPlan& plan);

}  // namespace mien::tests
