// What a run found out, as a table for people and as JSON for machines.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/conformance/check.h"

namespace mien::conformance {

struct Timing {
  double seconds = 0.0;     // of one call, the least of many
  double gflops = 0.0;      // 0 where nothing is multiplied and added
  double peak_share = 0.0;  // of the tier's measured peak
};

struct Row {
  std::string name;  // "pointwise", "network/basenet_encoder"
  std::string tier;
  int cases = 0;
  Finding finding;
  std::optional<Timing> timing;
};

struct Report {
  std::uint64_t seed = 1;
  int repeat = 1;
  std::map<std::string, double> peak_gflops;  // by tier, where it was measured
  std::vector<Row> rows;
  double seconds = 0.0;  // of the whole run

  [[nodiscard]] int failures() const;
};

// The lines above the table: tiers, seed, and what can be checked on this system.
void print_header(std::uint64_t seed, int repeat);
// Rows as they come.
void print_row(const Row& row);
void print_summary(const Report& report);

[[nodiscard]] std::string as_json(const Report& report);

}  // namespace mien::conformance
