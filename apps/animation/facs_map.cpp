// Converts between ARKit's controls and Roblox's units.
#include "apps/animation/facs_map.h"

#include <algorithm>

#include "apps/animation/clip.h"
#include "formats/vocabulary/facs_rows.h"

namespace mien::formats {
namespace {

// If one control is unknown, the other one counts.
double joined(double a, double b, Join join) {
  if (!driven(a) || !driven(b)) {
    return driven(a) ? a : b;
  }
  switch (join) {
    case Join::kMean:
      return (a + b) / 2.0;
    case Join::kMax:
      return std::max(a, b);
    case Join::kMin:
      return std::min(a, b);
  }
  return a;
}

}  // namespace

std::array<double, kFacsCount> facs_of(const std::array<double, kControlCount>& controls) {
  std::array<double, kFacsCount> facs;
  facs.fill(kNoNumber);
  for (const FacsRow& row : kFacsRows) {
    facs[row.unit] = joined(controls[row.first], controls[row.second], row.join);
  }
  return facs;
}

std::array<double, kControlCount> controls_of_facs(std::span<const double, kFacsCount> facs) {
  std::array<double, kControlCount> controls;
  controls.fill(kNoNumber);
  for (const FacsRow& row : kFacsRows) {
    if (row.join == Join::kMin) {
      continue;
    }
    controls[row.first] = joined(controls[row.first], facs[row.unit], Join::kMean);
    if (row.second != row.first) {
      controls[row.second] = joined(controls[row.second], facs[row.unit], Join::kMean);
    }
  }
  return controls;
}

}  // namespace mien::formats
