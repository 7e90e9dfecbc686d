// Compares two animations and prints a summary.
#include "apps/mien/compare/compare.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "apps/mien/compare/differences_json.h"
#include "apps/mien/compare/page.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/pages/web_video.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"

namespace mien::app {
namespace {

constexpr std::size_t kPrintedControls = 6;
constexpr double kLastFrameMs = 1000.0 / 30.0;  // duration of the last frame

// Uses names without folders if they differ.
void name_files(const CompareOptions& options, Comparison& comparison) {
  comparison.a.name = name_of(path_of(options.a).filename());
  comparison.b.name = name_of(path_of(options.b).filename());
  if (comparison.a.name == comparison.b.name) {
    comparison.a.name = options.a;
    comparison.b.name = options.b;
  }
}

Comparison compare_files(const CompareOptions& options) {
  Comparison comparison;
  name_files(options, comparison);
  Curves& a = comparison.a.curves;
  Curves& b = comparison.b.curves;
  a = read_curves(options.a, options.quiet);
  b = read_curves(options.b, options.quiet);
  const std::vector<FramePair> pairs = match_frames(a, b);
  if (pairs.empty()) {
    throw Failure(kExitNoInput, options.a + ", " + options.b + ": no frames at matching times");
  }
  comparison.differences = differences(a, b, pairs);
  comparison.start_ms = std::min(a.front().t_ms, b.front().t_ms);
  comparison.end_ms = std::max(a.back().t_ms, b.back().t_ms) + kLastFrameMs;
  return comparison;
}

void print_file(const ComparedFile& file) {
  std::printf("%s: %zu frames, %.2f to %.2f s\n", printable(file.name).c_str(), file.curves.size(),
              file.curves.front().t_ms * 1e-3, file.curves.back().t_ms * 1e-3);
}

void print_difference(const char* name, const Difference& d) {
  char correlation[16] = "-";
  if (d.correlation) {
    std::snprintf(correlation, sizeof correlation, "%.2f", *d.correlation);
  }
  std::printf("%-20s %9.4f %9.4f %8.2f %11s %8.3f %8.3f %9.5f %9.5f\n", name, d.mean_abs,
              d.max_abs.value, d.max_abs.t_ms * 1e-3, correlation, d.mean_a, d.mean_b, d.jitter_a,
              d.jitter_b);
}

// The controls in both files, sorted by decreasing difference.
std::vector<std::size_t> by_difference(const Differences& found) {
  std::vector<std::size_t> order(found.controls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return found.controls[i].frames == 0; });
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return found.controls[i].mean_abs > found.controls[j].mean_abs;
  });
  return order;
}

void print_head(const HeadDifference& head) {
  if (head.frames == 0) {
    std::printf("head pose: none in matched frames of both files\n");
    return;
  }
  std::printf(
      "head pose: mean difference %.2f degrees, maximum %.2f (at %.2f s);"
      " pitch %.2f, yaw %.2f, roll %.2f\n",
      head.rotation.mean_abs_deg, head.rotation.max_abs_deg.value,
      head.rotation.max_abs_deg.t_ms * 1e-3, head.pitch.mean_abs_deg, head.yaw.mean_abs_deg,
      head.roll.mean_abs_deg);
}

void print_summary(const Comparison& comparison) {
  const Differences& found = comparison.differences;
  print_file(comparison.a);
  print_file(comparison.b);
  const std::vector<std::size_t> order = by_difference(found);
  std::printf("%zu frames matched by time, %zu controls in both\n", found.matched_frames,
              order.size());
  if (!order.empty()) {
    std::printf("%-20s %9s %9s %8s %11s %8s %8s %9s %9s\n", "", "mean|A-B|", "max|A-B|", "at s",
                "correlation", "mean A", "mean B", "jitter A", "jitter B");
    print_difference("all", found.all);
    for (std::size_t i = 0; i < std::min(kPrintedControls, order.size()); ++i) {
      print_difference(mien_control_name(static_cast<std::int32_t>(order[i])),
                       found.controls[order[i]]);
    }
  }
  print_head(found.head);
}

}  // namespace

void compare(const CompareOptions& options) {
  require_distinct_files({options.a, options.b, options.video}, {options.page});
  Comparison comparison = compare_files(options);
  OutputFile file(options.page);  // opened first, so that an unwritable page fails before the work
  if (!options.video.empty()) {
    comparison.video = web_video({.video = options.video,
                                  .audio = options.video,
                                  .audio_track = 1,
                                  .rotation = std::nullopt,
                                  .start_s = comparison.start_ms * 1e-3,
                                  .duration_s = (comparison.end_ms - comparison.start_ms) * 1e-3},
                                 PartialFile(options.page + ".mp4", TemporaryFile::Ending::kAny));
  }
  file.write(compare_page(comparison));
  file.finish();
  if (options.json) {
    std::printf("%s\n", json_text(summary_json(comparison)).c_str());
  } else if (!options.quiet) {
    print_summary(comparison);
  }
}

}  // namespace mien::app
