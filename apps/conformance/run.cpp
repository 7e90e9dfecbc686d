// Selects, checks and times kernels and networks.
#include "apps/conformance/run.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <optional>

#include "apps/conformance/benchmark.h"
#include "apps/conformance/device_block.h"
#include "apps/conformance/glob.h"
#include "apps/conformance/kernel_suite.h"
#include "apps/conformance/network_suite.h"
#include "apps/conformance/report.h"
#include "apps/conformance/self_test.h"

namespace mien::conformance {
namespace {

using kernels::Tier;

ExitCode fail(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "mien-conformance: %s\n", message.c_str());
  return code;
}

std::optional<Tier> tier_by_name(const std::string& wanted) {
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if (wanted == kernels::name(static_cast<Tier>(tier))) {
      return static_cast<Tier>(tier);
    }
  }
  return std::nullopt;
}

std::string tier_names() {
  std::string names;
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    names += std::string(" ") + kernels::name(static_cast<Tier>(tier));
  }
  return names;
}

struct NetworkOnTier {
  Network network;
  Tier tier;
};

// The kernels and networks that match the options, in the order of the registry.
struct Selection {
  std::vector<Tier> tiers;
  std::vector<kernels::Entry> kernels;
  std::vector<NetworkOnTier> networks;

  [[nodiscard]] bool empty() const { return kernels.empty() && networks.empty(); }
};

std::vector<Tier> tiers_of(std::uint32_t mask) {
  std::vector<Tier> tiers;
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if ((mask & (1u << tier)) != 0) {
      tiers.push_back(static_cast<Tier>(tier));
    }
  }
  return tiers;
}

Selection select(const Options& options, std::uint32_t tiers) {
  Selection selection;
  selection.tiers = tiers_of(tiers);
  for (const kernels::Entry& entry : kernels::all_kernels()) {
    if ((tiers & kernels::bit(entry.tier)) != 0 && matches(options.filter, entry.family)) {
      selection.kernels.push_back(entry);
    }
  }
  for (const Network& network : Network::find_all(options.models)) {
    for (const Tier tier : selection.tiers) {
      if (network.has_cases(tier) && matches(options.filter, network.name())) {
        selection.networks.push_back({network, tier});
      }
    }
  }
  return selection;
}

void list(const Selection& selection) {
  for (const kernels::Entry& entry : selection.kernels) {
    std::printf("%-32s %s\n", std::string(entry.family).c_str(), kernels::name(entry.tier));
  }
  for (const auto& [network, tier] : selection.networks) {
    std::printf("%-32s %s\n", network.name().c_str(), kernels::name(tier));
  }
}

class Run {
 public:
  explicit Run(const Options& options)
      : options_(options), quiet_(options.json == "-" || options.block), begin_(Clock::now()) {
    report_.seed = options.seed;
    report_.repeat = options.repeat;
  }

  Report run(Selection& selection) {
    if (!quiet_) {
      print_header(options_.seed, options_.repeat);
    }
    measure_peaks(selection.tiers);
    for (const kernels::Entry& entry : selection.kernels) {
      add(
          std::string(entry.family), entry.tier,
          [&](std::uint64_t seed, int& cases) { return check_kernel(entry, seed, cases); },
          [&](double peak) { return time_kernel(entry, peak); });
    }
    for (NetworkOnTier& one : selection.networks) {
      add(
          one.network.name(), one.tier,
          [&](std::uint64_t seed, int& cases) { return one.network.check(one.tier, seed, cases); },
          [&](double peak) { return one.network.time(one.tier, peak); });
    }
    report_.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (!quiet_) {
      print_summary(report_);
    }
    return report_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void measure_peaks(const std::vector<Tier>& tiers) {
    for (const Tier tier : tiers) {
      if (options_.bench) {
        report_.peak_gflops[kernels::name(tier)] = peak_gflops(tier);
      }
    }
  }

  // Failed kernels are not timed.
  template <class Check, class Time>
  void add(const std::string& name, Tier tier, Check check, Time time) {
    Row row;
    row.name = name;
    row.tier = kernels::name(tier);
    double worst_share = 0.0;
    for (int i = 0; i < options_.repeat && row.finding.fault == Fault::kNone; ++i) {
      row.finding = check(options_.seed + static_cast<std::uint64_t>(i), row.cases);
      row.finding.worst_share = worst_share = std::max(worst_share, row.finding.worst_share);
    }
    if (options_.bench && row.finding.fault == Fault::kNone) {
      row.timing = time(report_.peak_gflops[row.tier]);
    }
    if (!quiet_) {
      print_row(row);
    }
    report_.rows.push_back(row);
  }

  const Options& options_;
  bool quiet_;
  Clock::time_point begin_;
  Report report_;
};

bool write(const std::string& path, const std::string& text) {
  if (path == "-") {
    return std::printf("%s\n", text.c_str()) > 0 && std::fflush(stdout) == 0;
  }
  std::ofstream file(path, std::ios::binary);
  file << text << '\n';
  return static_cast<bool>(file.flush());
}

}  // namespace

ExitCode run(const Options& options) {
  if (!has_all_references()) {
    return fail(kExitTrimmed,
                "this build has no reference kernels (got MIEN_TRIM_REF=ON, expected OFF)");
  }
  std::uint32_t tiers = kernels::detect_cpu();
  if (!options.tier.empty()) {
    const std::optional<Tier> tier = tier_by_name(options.tier);
    if (!tier) {
      return fail(kExitUsage,
                  "--tier: unknown tier (got " + options.tier + ", expected" + tier_names() + ")");
    }
    tiers &= kernels::bit(*tier);
    if (tiers == 0) {
      return fail(kExitUnsupportedTier,
                  "--tier: not supported by this CPU or build (got " + options.tier + ")");
    }
  }
  if (options.self_test) {
    return self_test() == 0 ? kExitOk : kExitFailures;
  }
  Selection selection = select(options, tiers);
  if (selection.empty()) {
    return fail(kExitNothing, "--filter: no match (got '" + options.filter + "')");
  }
  if (options.list) {
    list(selection);
    return kExitOk;
  }
  const Report report = Run(options).run(selection);
  if (!options.json.empty() && !write(options.json, as_json(report))) {
    return fail(kExitOutput, options.json + ": cannot be written");
  }
  if (options.block) {
    std::printf("%s", device_block(report).c_str());
  }
  return report.failures() == 0 ? kExitOk : kExitFailures;
}

}  // namespace mien::conformance
