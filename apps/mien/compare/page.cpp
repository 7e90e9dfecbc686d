#include "apps/mien/compare/page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/mien/compare/base64.h"
#include "apps/mien/compare/page_source.h"
#include "apps/mien/failure.h"

namespace mien::app {
namespace {

using nlohmann::ordered_json;

// What the eye can tell, and a fraction of the bytes. Not finite: null.
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

ordered_json file_json(const ComparedFile& file) {
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

ordered_json difference_json(const Difference& d) {
  return {{"frames", d.frames},
          {"mean_abs", d.mean_abs},
          {"max_abs", d.max_abs.value},
          {"max_at_ms", d.max_abs.t_ms},
          {"correlation", d.correlation ? ordered_json(*d.correlation) : ordered_json(nullptr)},
          {"mean_a", d.mean_a},
          {"mean_b", d.mean_b},
          {"jitter_a", d.jitter_a},
          {"jitter_b", d.jitter_b}};
}

ordered_json angle_difference_json(const AngleDifference& d) {
  return {{"mean_abs_deg", d.mean_abs_deg},
          {"max_abs_deg", d.max_abs_deg.value},
          {"max_at_ms", d.max_abs_deg.t_ms}};
}

ordered_json differences_json(const Differences& d) {
  ordered_json json;
  json["matched_frames"] = d.matched_frames;
  json["all"] = difference_json(d.all);
  json["controls"] = ordered_json::array();
  for (const Difference& control : d.controls) {
    json["controls"].push_back(difference_json(control));
  }
  json["head"] = {{"frames", d.head.frames},
                  {"pitch", angle_difference_json(d.head.pitch)},
                  {"yaw", angle_difference_json(d.head.yaw)},
                  {"roll", angle_difference_json(d.head.roll)},
                  {"rotation", angle_difference_json(d.head.rotation)}};
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
  json["a"] = file_json(comparison.a);
  json["b"] = file_json(comparison.b);
  json["differences"] = differences_json(comparison.differences);
  return json;
}

// JSON that can stand in a script element: outside strings it has no '<', and in a string the
// escape means the same, so nothing in a file's name can end the element.
std::string script_text(const ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    c == '<' ? safe += "\\u003c" : safe += c;
  }
  return safe;
}

void insert(std::string& page, const std::string& mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) {
    throw Failure(kExitInternal, "the page has no " + mark);
  }
  page.replace(at, mark.size(), text);
}

}  // namespace

std::string compare_page(const Comparison& comparison) {
  std::string page = kPageSource;
  // The video first: it cannot contain the other mark, the names of files could contain its.
  insert(page, "@VIDEO@", base64(comparison.video));
  insert(page, "@DATA@", script_text(page_json(comparison)));
  return page;
}

}  // namespace mien::app
