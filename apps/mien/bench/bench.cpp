// Measures networks and prints the results.
#include "apps/mien/bench/bench.h"

#include <mien/engine.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/mien/bench/audio_bench.h"
#include "apps/mien/bench/clip_bench.h"
#include "apps/mien/bench/layer_bench.h"
#include "apps/mien/bench/level_bench.h"
#include "apps/mien/bench/network_times.h"
#include "apps/mien/networks/model_files.h"
#include "apps/mien/networks/tiers.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

using Clock = std::chrono::steady_clock;

struct Figures {
  std::string name;
  std::string tier;
  std::uint64_t macs;
  double min_ms, median_ms, p95_ms;
  double gflops;  // from the median; a multiply-accumulate counts as two operations
  double peak_fraction;
  std::vector<StepTime> steps;  // with --layers
};

double seconds_from(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::vector<std::string> tiers_to_time(const std::string& chosen) {
  if (!chosen.empty()) {
    cpu_mask(chosen);
    return {chosen};
  }
  std::vector<std::string> tiers;
  for (std::uint32_t tier = 1; tier != 0 && tier <= mien_cpu_tiers(); tier <<= 1) {
    if ((mien_cpu_tiers() & tier) != 0) {
      tiers.emplace_back(mien_cpu_tier_name(tier));
    }
  }
  return tiers;
}

// The best of several short loops, because a long one is more likely to be interrupted.
double peak_gflops(const std::string& tier) {
  constexpr std::int64_t kRounds = 100'000;
  double best = 0.0;
  for (int i = 0; i < 30; ++i) {
    const auto begin = Clock::now();
    const std::int64_t macs = mien_cpu_multiply_adds(cpu_mask(tier), kRounds);
    best = std::max(best, 2.0 * static_cast<double>(macs) / seconds_from(begin) * 1e-9);
  }
  return best;
}

struct Subject {
  const Weights& weights;
  std::int32_t network;
  std::string name;
};

Figures time_network(const Subject& subject, const std::string& tier, double peak,
                     const BenchOptions& bench) {
  const auto& [weights, network, name] = subject;
  const WeightsContent content(weights);
  const NetworkInfo info = content.network(network);
  NetworkConfig config(weights, info.name);
  config.cpu_mask = cpu_mask(tier, bench.unfused);
  Network runner;
  Error error;
  if (runner.create(config, &error) != MIEN_OK) {
    throw Failure(kExitModel, name + ": " + error.message());
  }
  const std::vector<double> ms = network_times_ms(runner);
  Figures figures{name, tier, info.macs, ms.front(), ms[ms.size() / 2], ms[ms.size() * 95 / 100],
                  0.0,  0.0,  {}};
  figures.gflops = 2.0 * static_cast<double>(info.macs) / figures.median_ms * 1e-6;
  figures.peak_fraction = figures.gflops / peak;
  if (bench.layers) {
    figures.steps = time_steps(content, network, runner, peak);
  }
  return figures;
}

// The network "encoder" of "basenet.mien" has the name basenet_encoder.
std::string bench_name(const std::filesystem::path& path, std::string_view network) {
  return name_of(path.stem()) + "_" + std::string(network);
}

void time_file(const std::filesystem::path& path, const BenchOptions& options,
               const std::map<std::string, double>& peaks, std::vector<Figures>& results) {
  const OpenedWeights opened({name_of(path)});
  const WeightsContent file(opened.weights());
  for (std::int32_t i = 0; i < file.network_count(); ++i) {
    const std::string name = bench_name(path, file.network(i).name);
    if (!options.model.empty() && options.model != name) {
      continue;
    }
    for (const auto& [tier, peak] : peaks) {
      results.push_back(time_network({opened.weights(), i, name}, tier, peak, options));
    }
  }
}

void print_json(const std::map<std::string, double>& peaks, const std::vector<Figures>& results) {
  nlohmann::ordered_json json;
  json["peak_gflops"] = peaks;
  json["results"] = nlohmann::ordered_json::array();
  for (const Figures& f : results) {
    json["results"].push_back({{"name", f.name},
                               {"tier", f.tier},
                               {"macs", f.macs},
                               {"min_ms", f.min_ms},
                               {"median_ms", f.median_ms},
                               {"p95_ms", f.p95_ms},
                               {"gflops", f.gflops},
                               {"peak_fraction", f.peak_fraction}});
    if (!f.steps.empty()) {
      json["results"].back()["layers"] = to_json(f.steps);
    }
  }
  std::printf("%s\n", json_text(json).c_str());
}

void print_table(const std::map<std::string, double>& peaks, const std::vector<Figures>& results) {
  for (const auto& [tier, peak] : peaks) {
    std::printf("peak of %s: %.1f GFLOP/s\n", tier.c_str(), peak);
  }
  std::printf("%-28s %-6s %10s %9s %9s %9s %9s %6s\n", "network", "tier", "MACs", "min ms",
              "median ms", "p95 ms", "GFLOP/s", "peak");
  for (const Figures& f : results) {
    std::printf("%-28s %-6s %10llu %9.4f %9.4f %9.4f %9.2f %5.0f%%\n", f.name.c_str(),
                f.tier.c_str(), static_cast<unsigned long long>(f.macs), f.min_ms, f.median_ms,
                f.p95_ms, f.gflops, f.peak_fraction * 100.0);
    print(f.steps);
  }
}

}  // namespace

void bench(const BenchOptions& options) {
  if (!options.clip.empty()) {
    return bench_clip(options);
  }
  if (!options.levels.empty()) {
    return bench_levels(options);
  }
  if (options.audio) {
    return bench_audio(options);
  }
  std::map<std::string, double> peaks;
  for (const std::string& tier : tiers_to_time(options.tier)) {
    peaks[tier] = peak_gflops(tier);
  }
  std::vector<Figures> results;
  for (const auto& path : weight_files(models_directory(options.models))) {
    time_file(path, options, peaks, results);
  }
  if (results.empty()) {
    throw Failure(kExitUsage, "--model: unknown network '" + options.model + "'");
  }
  options.json ? print_json(peaks, results) : print_table(peaks, results);
}

}  // namespace mien::app
