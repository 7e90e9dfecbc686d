// Converts between ARKit's controls and Roblox's units.
#include "apps/animation/facs_map.h"

#include <algorithm>

#include "apps/animation/clip.h"
#include "formats/vocabulary/facs_rows.h"

namespace mien::animation {
namespace {

// If one control is unknown, the other one counts.
double joined(double a, double b, formats::Join join) {
  if (!formats::driven(a) || !formats::driven(b)) {
    return formats::driven(a) ? a : b;
  }
  switch (join) {
    case formats::Join::kMean:
      return (a + b) / 2.0;
    case formats::Join::kMax:
      return std::max(a, b);
    case formats::Join::kMin:
      return std::min(a, b);
  }
  return a;
}

}  // namespace

std::array<double, formats::kFacsCount> facs_of(
    const std::array<double, formats::kControlCount>& controls) {
  std::array<double, formats::kFacsCount> facs;
  facs.fill(formats::kNoNumber);
  for (const formats::FacsRow& row : formats::kFacsRows) {
    facs[row.unit] = joined(controls[row.first], controls[row.second], row.join);
  }
  return facs;
}

std::array<double, formats::kControlCount> controls_of_facs(
    std::span<const double, formats::kFacsCount> facs) {
  std::array<double, formats::kControlCount> controls;
  controls.fill(formats::kNoNumber);
  for (const formats::FacsRow& row : formats::kFacsRows) {
    if (row.join == formats::Join::kMin) {
      continue;
    }
    controls[row.first] = joined(controls[row.first], facs[row.unit], formats::Join::kMean);
    if (row.second != row.first) {
      controls[row.second] = joined(controls[row.second], facs[row.unit], formats::Join::kMean);
    }
  }
  return controls;
}

}  // namespace mien::animation
