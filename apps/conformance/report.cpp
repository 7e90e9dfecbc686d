// Prints the table and writes JSON.
#include "apps/conformance/report.h"

#include <mien/mien.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/conformance/crash_guard.h"
#include "apps/conformance/guarded_buffer.h"
#include "apps/conformance/registers.h"
#include "apps/conformance/terminal.h"
#include "kernels/tier.h"

namespace mien::conformance {
namespace {

std::vector<std::string> tiers_here() {
  std::vector<std::string> names;
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if ((kernels::detect_cpu() & (1u << tier)) != 0) {
      names.emplace_back(kernels::name(static_cast<kernels::Tier>(tier)));
    }
  }
  return names;
}

const char* yes_or_no(bool yes) { return yes ? "yes" : "not supported here"; }

std::string timing_text(const std::optional<Timing>& timing) {
  if (!timing) {
    return "";
  }
  char text[64];
  if (timing->gflops > 0.0) {
    std::snprintf(text, sizeof text, " %12.3f %9.2f %5.0f%%", timing->seconds * 1e6, timing->gflops,
                  timing->peak_share * 100.0);
  } else {
    std::snprintf(text, sizeof text, " %12.3f %9s %6s", timing->seconds * 1e6, "-", "-");
  }
  return text;
}

nlohmann::ordered_json as_json(const Row& row) {
  nlohmann::ordered_json json = {{"name", row.name},
                                 {"tier", row.tier},
                                 {"cases", row.cases},
                                 {"result", name(row.finding.fault)},
                                 {"worst_share", row.finding.worst_share}};
  if (row.finding.fault != Fault::kNone) {
    json["detail"] = row.finding.text;
  }
  if (row.timing) {
    json["seconds"] = row.timing->seconds;
    if (row.timing->gflops > 0.0) {
      json["gflops"] = row.timing->gflops;
      json["peak_share"] = row.timing->peak_share;
    }
  }
  return json;
}

}  // namespace

int Report::failures() const {
  return static_cast<int>(std::count_if(
      rows.begin(), rows.end(), [](const Row& row) { return row.finding.fault != Fault::kNone; }));
}

void print_header(std::uint64_t seed, int repeat) {
  std::string tiers;
  for (const std::string& one : tiers_here()) {
    tiers += " " + one;
  }
  const char* convention = register_convention();
  std::printf("mien %s; tiers:%s; seed %llu, %d seeds\n", mien_version(), tiers.c_str(),
              static_cast<unsigned long long>(seed), repeat);
  std::printf("guard pages: %s; crashes: %s; registers: %s\n", yes_or_no(have_guard_pages()),
              yes_or_no(can_catch_crashes()),
              convention != nullptr ? convention : yes_or_no(false));
  std::printf("%-32s %-8s %6s %6s  %-8s %12s %9s %6s\n", "name", "tier", "cases", "worst", "result",
              "us", "GFLOP/s", "peak");
}

void print_row(const Row& row) {
  const bool good = row.finding.fault == Fault::kNone;
  const Colours& colour = colours();
  std::printf("%-32s %-8s %6d %5.0f%%  %s%-8s%s%s\n", row.name.c_str(), row.tier.c_str(), row.cases,
              std::min(row.finding.worst_share, 99.99) * 100.0, good ? colour.good : colour.bad,
              name(row.finding.fault), colour.end, timing_text(row.timing).c_str());
  if (!good) {
    std::printf("    %s\n", row.finding.text.c_str());
  }
  std::fflush(stdout);
}

void print_summary(const Report& report) {
  const Colours& colour = colours();
  for (const auto& [tier, gflops] : report.peak_gflops) {
    std::printf("%speak of %s: %.1f GFLOP/s%s\n", colour.faint, tier.c_str(), gflops, colour.end);
  }
  const int failures = report.failures();
  std::printf("%s%zu checked, %d failed%s, %.1f s\n", failures == 0 ? colour.good : colour.bad,
              report.rows.size(), failures, colour.end, report.seconds);
}

std::string as_json(const Report& report) {
  nlohmann::ordered_json json;
  json["mien_conformance"] = 1;
  json["version"] = mien_version();
  json["tiers"] = tiers_here();
  json["seed"] = report.seed;
  json["repeat"] = report.repeat;
  const char* convention = register_convention();
  json["checks"] = {{"guard_pages", have_guard_pages()}, {"crashes", can_catch_crashes()}};
  json["checks"]["registers"] =
      convention != nullptr ? nlohmann::ordered_json(convention) : nlohmann::ordered_json();
  json["peak_gflops"] = report.peak_gflops;
  json["results"] = nlohmann::ordered_json::array();
  for (const Row& row : report.rows) {
    json["results"].push_back(as_json(row));
  }
  json["failures"] = report.failures();
  json["total_seconds"] = report.seconds;
  return json.dump(1);
}

}  // namespace mien::conformance
