// usage: mien_soak HOURS -> a report, as lines of a Markdown table
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

#include "tests/tracker/soak.h"

int main(int argc, char** argv) {
  const double hours = argc == 2 ? std::atof(argv[1]) : 0.0;
  if (!(hours > 0.0)) {
    std::fprintf(stderr, "usage: mien_soak HOURS\n");
    return 2;
  }
  bool good = true;
  for (const double skew : {50e-6, -50e-6}) {
    const mien::tests::SoakReport report =
        mien::tests::soak({.seconds = 3600 * hours, .skew = skew});
    std::printf("| %+.0f | %.2f | %lld | %lld | %d | %d | %d | %.2f | %.2f | %.1f | %.1f |\n",
                skew * 1e6, hours, static_cast<long long>(report.frames),
                static_cast<long long>(report.frames_with_face), report.gaps, report.rate_changes,
                report.bursts, report.mean_error_ms, report.largest_error_ms,
                static_cast<double>(report.resident_bytes_early) / (1 << 20),
                static_cast<double>(report.resident_bytes_late) / (1 << 20));
    std::fflush(stdout);
    good &= report.largest_error_ms < 20.0 &&
            report.resident_bytes_late < report.resident_bytes_early + (1u << 20);
  }
  return good ? 0 : 1;
}
