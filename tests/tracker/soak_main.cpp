// Runs the soak test for hours and prints a report in Markdown: half of the time with a fast audio
// clock, half with a slow one. Exit status 0 if all limits are kept.
// usage: mien_soak HOURS
#include <cstdio>
#include <cstdlib>

#include "tests/tracker/soak.h"

namespace {

using mien::tests::SoakReport;

constexpr double kMiB = 1 << 20;

bool row(const char* what, double fast, double slow, double at_most, const char* form = "%.0f") {
  const auto cell = [&](double value) {
    std::printf(" | ");
    std::printf(form, value);
  };
  std::printf("| %s", what);
  cell(fast);
  cell(slow);
  const bool bounded = at_most >= 0.0;
  const bool good = !bounded || (fast <= at_most && slow <= at_most);
  if (bounded) {
    cell(at_most);
    std::printf(" | %s |\n", good ? "yes" : "**no**");
  } else {
    std::printf(" | | |\n");
  }
  return good;
}

bool report(double hours, const SoakReport& fast, const SoakReport& slow) {
  const auto megabytes = [](std::size_t bytes) { return static_cast<double>(bytes) / kMiB; };
  const auto lost_ids = [](const SoakReport& a) {
    return static_cast<double>(a.last_face_id) - static_cast<double>(a.faces_found);
  };
  const auto number = [](auto count) { return static_cast<double>(count); };
  const double none = -1.0;
  std::printf("| | clock +50 ppm | clock -50 ppm | at most | kept |\n|---|---|---|---|---|\n");
  row("frames", number(fast.frames), number(slow.frames), none);
  row("mean timing error, ms", fast.mean_error_ms, slow.mean_error_ms, none, "%.2f");
  bool good = row("largest timing error, ms", fast.max_error_ms, slow.max_error_ms, 20.0, "%.2f");
  good &= row("results with NaN, infinity or a value out of range", number(fast.invalid_results),
              number(slow.invalid_results), 0.0);
  good &= row("ids above the number of faces", lost_ids(fast), lost_ids(slow), 0.0);
  row("resident at the end, MiB", megabytes(fast.resident_bytes_late),
      megabytes(slow.resident_bytes_late), none, "%.2f");
  const auto grown = [&](const SoakReport& a) { return a.memory_slope_bytes * hours / 1024.0; };
  good &= row("growth of memory, KiB", grown(fast), grown(slow), 64.0, "%.2f");
  row("an image, median, us", fast.median_us, slow.median_us, none, "%.1f");
  row("an image, maximum, us", fast.worst_us, slow.worst_us, none, "%.0f");
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  const double hours = argc == 2 ? std::atof(argv[1]) : 0.0;
  if (!(hours > 0.0)) {
    std::fprintf(stderr, "usage: mien_soak HOURS\n");
    return 2;
  }
  const double each = hours / 2.0;
  const SoakReport fast = mien::tests::soak({.seconds = 3600.0 * each, .skew = 50e-6});
  const SoakReport slow = mien::tests::soak({.seconds = 3600.0 * each, .skew = -50e-6});
  return report(each, fast, slow) ? 0 : 1;
}
