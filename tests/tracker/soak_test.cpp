// A short soak test; scripts/measure/soak.sh runs the long one.
#include "tests/tracker/soak.h"

#include <gtest/gtest.h>

#include "tests/tracker/times.h"

namespace mien::tests {
namespace {

TEST(Soak, AudioAndVideoStaySynchronized) {
  for (const double skew : {50e-6, -50e-6}) {
    const SoakReport report = soak(
        {.seconds = 150, .skew = skew, .seconds_between_gaps = 15, .seconds_between_rates = 22});
    EXPECT_GT(report.bursts, 40);
    EXPECT_GT(report.gaps, 4);
    EXPECT_GT(report.rate_changes, 2);
    EXPECT_GT(report.frames_with_face, report.frames * 9 / 10);
    EXPECT_LT(report.max_error_ms, 20.0);
    EXPECT_GT(report.audio_steps, 8000);
    EXPECT_EQ(report.invalid_results, 0);
    EXPECT_GE(report.faces_found, 2u);
    EXPECT_EQ(report.last_face_id, report.faces_found);
    EXPECT_GT(report.median_us, 0.0);
    EXPECT_GE(report.p999_us, report.median_us);
    EXPECT_GE(report.worst_us, report.p999_us);
    EXPECT_LT(report.resident_bytes_late, report.resident_bytes_early + MIEN_SOAK_GROWTH_BYTES);
  }
}

TEST(Times, PercentilesAreAtMostTheMaximum) {
  for (int i = 0; i < 100; ++i) {
    const double us = 100.0 + 0.1 * i;
    Times times;
    times.add(us);
    EXPECT_LE(times.percentile(0.999), us);
    EXPECT_NEAR(times.percentile(0.5), us, 0.006 * us);
  }
}

TEST(Times, PercentilesAreAccurateToOnePercent) {
  Times times;
  for (int i = 1; i <= 10000; ++i) {
    times.add(10.0 * i);
  }
  EXPECT_NEAR(times.percentile(0.5), 50000.0, 500.0);
  EXPECT_NEAR(times.percentile(0.999), 99900.0, 999.0);
  EXPECT_EQ(times.worst(), 100000.0);
}

}  // namespace
}  // namespace mien::tests
