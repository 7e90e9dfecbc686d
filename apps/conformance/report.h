// The results of a run, as a table and as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/conformance/check.h"

namespace mien::conformance {

struct Timing {
  double seconds = 0.0;     // minimum of many calls
  double gflops = 0.0;      // 0 without multiply-adds
  double peak_share = 0.0;  // relative to the tier's measured peak
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
  std::map<std::string, double> peak_gflops;  // by tier, if measured
  std::vector<Row> rows;
  double seconds = 0.0;  // duration of the run

  [[nodiscard]] int failures() const;
};

// Prints the lines above the table: tiers, seed, and the checks that this system supports.
void print_header(std::uint64_t seed, int repeat);
// Prints a row of the table.
void print_row(const Row& row);
void print_summary(const Report& report);

[[nodiscard]] std::string as_json(const Report& report);

}  // namespace mien::conformance
