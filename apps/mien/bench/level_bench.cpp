// Measures each level of detail, stage by stage.
#include "apps/mien/bench/level_bench.h"

#include <mien/engine.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mien/mien.hpp>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/mien/bench/network_times.h"
#include "apps/mien/bench/nv12_clip.h"
#include "apps/mien/networks/model_files.h"
#include "apps/mien/networks/tiers.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kFrames = 60;
constexpr int kMaxStarts = 20;
constexpr int kRepetitions = 33;  // repetitions of all networks per round
constexpr std::int64_t kFrameNs = 33'333'333;
constexpr std::int32_t kSoundRate = 16'000;
constexpr int kMaxLevel = 4;

// A network that runs on a frame of the highest level.
struct Part {
  const char* file;
  const char* network;
};
constexpr std::array kParts = {
    Part{"basenet", "encoder"},          Part{"basenet", "landmarks"},
    Part{"basenet", "face_probability"}, Part{"basenet", "pose_decoder"},
    Part{"hifinet", "encoder"},          Part{"hifinet", "landmarks"},
    Part{"hifinet", "controls_decoder"},
};

// Microseconds of one frame, or the mean of several.
struct FrameTime {
  double whole = 0.0;
  std::array<double, MIEN_STAGE_COUNT> stages = {};

  void keep_fastest(const FrameTime& other) {
    whole = std::min(whole, other.whole);
    for (std::size_t i = 0; i < stages.size(); ++i) {
      stages[i] = std::min(stages[i], other.stages[i]);
    }
  }
};

struct Level {
  int lod;
  FrameTime frame;  // mean
};

struct LevelTimes {
  double start_ms = 0.0;
  double networks_us = 0.0;  // of the highest level, each repeated by itself
  double sequence_us = 0.0;  // in sequence as in a frame, so they share the caches
  std::vector<Level> levels;

  [[nodiscard]] double highest_us() const { return levels.back().frame.whole; }
};

double us_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

LoadedTracker::Options tracker_options(const BenchOptions& options, int lod) {
  return {.models = options.models,
          .tier = options.tier,
          .lod = lod,
          .sound = has_audionet(options.models),
          .unfused = options.unfused};
}

// From files in the system's cache to a tracker.
double fastest_start_ms(const BenchOptions& options) {
  double fastest = 1e9;
  for (int i = 0; i < std::min(kMaxStarts, options.rounds); ++i) {
    const auto begin = Clock::now();
    const LoadedTracker loaded(tracker_options(options, kMaxLevel));
    fastest = std::min(fastest, us_since(begin) * 1e-3);
  }
  return fastest;
}

// A network ready to run.
struct TimedNetwork {
  OpenedWeights file;
  Network runner;
  double fastest_us = 1e9;

  TimedNetwork(const Part& part, const BenchOptions& options)
      : file({models_directory(options.models) + "/" + part.file + ".mien"}) {
    NetworkConfig config(file.weights(), part.network);
    config.cpu_mask = cpu_mask(options.tier, options.unfused);
    Error error;
    if (runner.create(config, &error) != MIEN_OK) {
      throw Failure(kExitModel, std::string(part.file) + ".mien: " + error.message());
    }
  }

  void run() {
    const auto begin = Clock::now();
    runner.run();
    fastest_us = std::min(fastest_us, us_since(begin));
  }
};

void time_networks(const BenchOptions& options, LevelTimes& report) {
  std::vector<std::unique_ptr<TimedNetwork>> networks;
  for (const Part& part : kParts) {
    networks.push_back(std::make_unique<TimedNetwork>(part, options));
    report.networks_us += network_times_ms(networks.back()->runner).front() * 1e3;
  }
  for (int turn = 0; turn < kRepetitions * options.rounds; ++turn) {
    for (const auto& network : networks) {
      network->run();
    }
  }
  for (const auto& network : networks) {
    report.sequence_us += network->fastest_us;
  }
}

// Pushes the audio of one frame, so that there is audio to mix; not measured.
void push_audio(Tracker& tracker, std::int64_t pts_ns) {
  static const std::vector<float> hum(kSoundRate / 30, 0.01f);
  Audio audio;
  audio.sample_rate = kSoundRate;
  audio.frames = hum.size();
  audio.samples[0] = hum.data();
  check(tracker.push_audio(audio, pts_ns), "bench");
}

// Measures every frame without detection.
std::vector<FrameTime> one_round(LoadedTracker& loaded, const Nv12Clip& clip) {
  std::vector<FrameTime> times;
  check(loaded.tracker.reset(), "bench");
  for (std::size_t i = 0; i < clip.frames(); ++i) {
    const std::int64_t pts_ns = static_cast<std::int64_t>(i) * kFrameNs;
    if (loaded.has_audio) {
      push_audio(loaded.tracker, pts_ns);
    }
    const mien_image image = clip.frame(i);
    const auto begin = Clock::now();
    const mien_status status = loaded.tracker.push_video(image, pts_ns);
    FrameTime time{us_since(begin), {}};
    check(status, "bench");
    Result result;
    check(loaded.tracker.get_result(result), "bench");
    if (result.status != MIEN_FACE_TRACKING || (result.flags & MIEN_RESULT_PROPOSAL_RAN) != 0) {
      continue;
    }
    for (std::size_t stage = 0; stage < time.stages.size(); ++stage) {
      time.stages[stage] = static_cast<double>(result.stage_ns[stage]) * 1e-3;
    }
    times.push_back(time);
  }
  return times;
}

FrameTime mean(const std::vector<FrameTime>& frames) {
  FrameTime sum;
  for (const FrameTime& frame : frames) {
    sum.whole += frame.whole / static_cast<double>(frames.size());
    for (std::size_t i = 0; i < sum.stages.size(); ++i) {
      sum.stages[i] += frame.stages[i] / static_cast<double>(frames.size());
    }
  }
  return sum;
}

FrameTime mean_frame(int lod, const Nv12Clip& clip, const BenchOptions& options) {
  LoadedTracker loaded(tracker_options(options, lod));
  std::vector<FrameTime> fastest = one_round(loaded, clip);
  for (int round = 1; round < options.rounds; ++round) {
    const std::vector<FrameTime> again = one_round(loaded, clip);
    for (std::size_t i = 0; i < fastest.size(); ++i) {
      fastest[i].keep_fastest(again[i]);
    }
  }
  if (fastest.empty()) {
    throw Failure(kExitNoVideo, options.levels + ": no face");
  }
  return mean(fastest);
}

LevelTimes measure(const BenchOptions& options) {
  const Nv12Clip clip(options.levels, kFrames);
  LevelTimes report;
  report.start_ms = fastest_start_ms(options);
  time_networks(options, report);
  for (int lod = 1; lod <= kMaxLevel; ++lod) {
    report.levels.push_back({lod, mean_frame(lod, clip, options)});
  }
  return report;
}

void print_json(const LevelTimes& report) {
  nlohmann::ordered_json json = {{"start_ms", report.start_ms},
                                 {"networks_of_highest_us", report.networks_us},
                                 {"highest_of_networks", report.highest_us() / report.networks_us},
                                 {"networks_in_turn_us", report.sequence_us}};
  for (const Level& level : report.levels) {
    nlohmann::ordered_json stages;
    for (std::size_t i = 0; i < level.frame.stages.size(); ++i) {
      stages[mien_stage_name(static_cast<std::int32_t>(i))] = level.frame.stages[i];
    }
    json["levels"].push_back({{"lod", level.lod},
                              {"mean_us", level.frame.whole},
                              {"of_highest", level.frame.whole / report.highest_us()},
                              {"stages_us", stages}});
  }
  std::printf("%s\n", json.dump(1).c_str());
}

void print_table(const LevelTimes& report) {
  std::printf("start-up: %.2f ms\n", report.start_ms);
  std::printf("%5s %10s %9s", "level", "mean us", "of 4");
  for (std::int32_t stage = MIEN_STAGE_WARP; stage <= MIEN_STAGE_DECODERS; ++stage) {
    std::printf(" %9s", mien_stage_name(stage));
  }
  std::printf("\n");
  for (const Level& level : report.levels) {
    std::printf("%5d %10.1f %9.2f", level.lod, level.frame.whole,
                level.frame.whole / report.highest_us());
    for (std::size_t stage = MIEN_STAGE_WARP; stage <= MIEN_STAGE_DECODERS; ++stage) {
      std::printf(" %9.1f", level.frame.stages[stage]);
    }
    std::printf("\n");
  }
  std::printf(
      "networks of level 4, each repeated by itself: %.1f us; a frame takes %.2f times as long\n",
      report.networks_us, report.highest_us() / report.networks_us);
  std::printf("networks in sequence: %.1f us; a frame takes %.2f times as long\n",
              report.sequence_us, report.highest_us() / report.sequence_us);
}

}  // namespace

void bench_levels(const BenchOptions& options) {
  const LevelTimes report = measure(options);
  options.json ? print_json(report) : print_table(report);
}

}  // namespace mien::app
