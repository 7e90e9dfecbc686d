// Converts differences to JSON.
#include "apps/mien/compare/differences_json.h"

namespace mien::app {
namespace {

using nlohmann::ordered_json;

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

}  // namespace

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

namespace {

ordered_json file_json(const ComparedFile& file) {
  return {{"name", file.name},
          {"frames", file.curves.size()},
          {"start_ms", file.curves.front().t_ms},
          {"last_ms", file.curves.back().t_ms}};
}

}  // namespace

ordered_json summary_json(const Comparison& comparison) {
  ordered_json summary = {{"a", file_json(comparison.a)}, {"b", file_json(comparison.b)}};
  summary.update(differences_json(comparison.differences));
  ordered_json controls = ordered_json::object();  // those in both files
  for (std::size_t i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    if (comparison.differences.controls[i].frames > 0) {
      controls[mien_control_name(static_cast<std::int32_t>(i))] = summary["controls"][i];
    }
  }
  summary["controls"] = controls;
  return summary;
}

}  // namespace mien::app
