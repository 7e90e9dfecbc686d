// Compares tracking with detection on every frame.
#include "apps/mien/bench/clip_bench.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;

// Milliseconds per frame of two trackers that alternate.
struct FrameTimes {
  std::vector<double> followed;
  std::vector<double> proposed;
  std::uint64_t proposal_runs = 0;  // of the tracker without resets
};

double time_ms(Tracker& tracker, const mien_image& image, std::int64_t pts_ns,
               const std::string& input) {
  const auto begin = Clock::now();
  const mien_status status = tracker.push_video(image, pts_ns);
  const std::chrono::duration<double, std::milli> spent = Clock::now() - begin;
  check(status, input);
  return spent.count();
}

FrameTimes time_frames(const BenchOptions& options) {
  const LoadedTracker::Options loaded = {
      .models = options.models, .tier = options.tier, .unfused = options.unfused};
  LoadedTracker following(loaded);
  LoadedTracker proposing(loaded);
  const std::unique_ptr<VideoSource> video = open_video(options.clip, {});
  FrameTimes times;
  mien_image image;
  for (std::int64_t pts_ns = 0; video->next(image, pts_ns);) {
    times.followed.push_back(time_ms(following.tracker, image, pts_ns, options.clip));
    check(proposing.tracker.reset(), options.clip);
    times.proposed.push_back(time_ms(proposing.tracker, image, pts_ns, options.clip));
  }
  Result last;
  if (times.followed.empty() || following.tracker.get_result(last) != MIEN_OK) {
    throw Failure(kExitNoVideo, options.clip + ": no frames");
  }
  times.proposal_runs = last.proposal_runs;
  return times;
}

struct Spread {
  double mean, median, p95;
};

Spread spread(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  const auto n = static_cast<double>(ms.size());
  return {std::accumulate(ms.begin(), ms.end(), 0.0) / n, ms[ms.size() / 2],
          ms[(ms.size() - 1) * 95 / 100]};
}

nlohmann::ordered_json to_json(const Spread& s) {
  return {{"mean_ms", s.mean}, {"median_ms", s.median}, {"p95_ms", s.p95}};
}

void print_row(const char* name, const Spread& s) {
  std::printf("%-24s mean %8.3f ms  median %8.3f ms  p95 %8.3f ms\n", name, s.mean, s.median,
              s.p95);
}

}  // namespace

void bench_clip(const BenchOptions& options) {
  const FrameTimes times = time_frames(options);
  const Spread followed = spread(times.followed);
  const Spread proposed = spread(times.proposed);
  const double speedup = proposed.mean / followed.mean;
  if (options.json) {
    const nlohmann::ordered_json json = {{"clip", options.clip},
                                         {"frames", times.followed.size()},
                                         {"proposal_runs", times.proposal_runs},
                                         {"followed", to_json(followed)},
                                         {"proposed_on_every_frame", to_json(proposed)},
                                         {"speedup", speedup}};
    std::printf("%s\n", json_text(json).c_str());
    return;
  }
  std::printf("%zu frames, %llu with detection\n", times.followed.size(),
              static_cast<unsigned long long>(times.proposal_runs));
  print_row("followed", followed);
  print_row("detection on every frame", proposed);
  std::printf("tracking is %.1f times as fast\n", speedup);
}

}  // namespace mien::app
