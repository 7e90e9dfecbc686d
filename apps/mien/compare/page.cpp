// Fills the page of `mien compare` with data.
#include "apps/mien/compare/page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/animation/base64.h"
#include "apps/mien/compare/differences_json.h"
#include "apps/mien/pages/page_sources.h"
#include "apps/mien/pages/page_text.h"

namespace mien::app {
namespace {

using nlohmann::ordered_json;

// Rounds to visible precision to save space. Non-finite values become null.
ordered_json rounded(double value, double steps_per_unit) {
  if (!std::isfinite(value)) {
    return nullptr;
  }
  return std::round(value * steps_per_unit) / steps_per_unit;
}

ordered_json control_json(const Curves& curves, std::size_t control) {
  ordered_json values = ordered_json::array();
  bool driven = false;
  for (const CurvesFrame& frame : curves) {
    values.push_back(rounded(frame.controls[control], 1e4));
    driven = driven || !values.back().is_null();
  }
  return driven ? values : ordered_json(nullptr);
}

ordered_json angle_json(const Curves& curves, double HeadAngles::*angle) {
  ordered_json values = ordered_json::array();
  for (const CurvesFrame& frame : curves) {
    values.push_back(frame.head ? rounded((*frame.head).*angle, 1e4) : ordered_json(nullptr));
  }
  return values;
}

ordered_json page_file(const ComparedFile& file) {
  ordered_json json;
  json["name"] = file.name;
  json["t_ms"] = ordered_json::array();
  for (const CurvesFrame& frame : file.curves) {
    json["t_ms"].push_back(rounded(frame.t_ms, 1e2));
  }
  json["pitch"] = angle_json(file.curves, &HeadAngles::pitch);
  json["yaw"] = angle_json(file.curves, &HeadAngles::yaw);
  json["roll"] = angle_json(file.curves, &HeadAngles::roll);
  json["controls"] = ordered_json::array();
  for (std::size_t i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    json["controls"].push_back(control_json(file.curves, i));
  }
  return json;
}

ordered_json page_json(const Comparison& comparison) {
  ordered_json json;
  json["controls"] = ordered_json::array();
  for (std::int32_t i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    json["controls"].push_back(mien_control_name(i));
  }
  json["start_ms"] = comparison.start_ms;
  json["end_ms"] = comparison.end_ms;
  json["a"] = page_file(comparison.a);
  json["b"] = page_file(comparison.b);
  json["differences"] = differences_json(comparison.differences);
  return json;
}

}  // namespace

std::string compare_page(const Comparison& comparison) {
  return filled(kComparePage, {{"@DATA@", script_text(page_json(comparison))},
                               {"@VIDEO@", animation::base64(comparison.video)},
                               {"@AVATAR@", kAvatarScript}});
}

}  // namespace mien::app
