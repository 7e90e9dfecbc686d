// Writes the events of the page.
#include "apps/mien/live_page/page_link.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/mien/live_page/preview.h"
#include "apps/mien/system/json_text.h"

namespace mien::app {
namespace {

using nlohmann::ordered_json;

constexpr double kStepsPerUnit = 1e4;

// Rounds to visible precision. NaN, the value of controls that are not driven, becomes null.
ordered_json rounded(double value, double steps_per_unit) {
  return std::isfinite(value) ? ordered_json(std::round(value * steps_per_unit) / steps_per_unit)
                              : ordered_json(nullptr);
}

ordered_json controls_json(const animation::Frame& frame) {
  ordered_json values = ordered_json::array();
  for (const double value : frame.controls) {
    values.push_back(rounded(value, kStepsPerUnit));
  }
  return values;
}

ordered_json input_json(const InputState& input) {
  return {{"name", input.name}, {"error", input.error}};
}

ordered_json senders_json(const std::vector<ReceiverState>& receivers) {
  ordered_json senders = ordered_json::array();
  for (const ReceiverState& receiver : receivers) {
    senders.push_back(
        {{"name", receiver.name}, {"detail", receiver.detail}, {"paused", receiver.paused}});
  }
  return senders;
}

// [gain, dead zone] of each control.
ordered_json adjustments_json(const Profile& profile) {
  ordered_json list = ordered_json::array();
  for (const Adjustment& adjustment : profile.controls) {
    list.push_back({adjustment.gain, adjustment.dead_zone});
  }
  return list;
}

}  // namespace

void PageLink::show(const animation::Frame& sent, const animation::Frame& raw) {
  ordered_json json = {{"n", sent.number}, {"t_ns", sent.time_ns}, {"status", name(sent.state)}};
  json["controls"] = controls_json(sent);
  json["raw"] = controls_json(raw);
  if (sent.head) {
    json["pitch"] = rounded(sent.head->pitch, kStepsPerUnit);
    json["yaw"] = rounded(sent.head->yaw, kStepsPerUnit);
    json["roll"] = rounded(sent.head->roll, kStepsPerUnit);
  }
  json["voice"] = rounded(sent.voice_activity, kStepsPerUnit);
  board_.put_frame(json_text(json, -1));
}

void PageLink::show(const mien_image& image) {
  if (board_.preview_wanted()) {
    board_.put_preview(preview_of(image));
  }
}

void PageLink::show(const ScreenState& screen, const PageState& page,
                    const LiveStatistics& statistics, const Profile& profile) {
  const ordered_json json = {{"camera", input_json(screen.camera)},
                             {"microphone", input_json(screen.microphone)},
                             {"senders", senders_json(screen.receivers)},
                             {"level", screen.level},
                             {"automatic", screen.automatic},
                             {"mirrored", screen.mirrored},
                             {"calibrating", screen.calibrating},
                             {"dropped_images", screen.dropped_images},
                             {"dropped_packets", screen.dropped_packets},
                             {"fps", rounded(statistics.frames_per_second(), 1)},
                             {"latency_ms", rounded(statistics.latency().quantile(0.5), 10)},
                             {"adjustments", adjustments_json(profile)},
                             {"profile_file", page.profile_file},
                             {"message", page.message},
                             {"saved", page.saved}};
  board_.put_state(json_text(json, -1));
}

}  // namespace mien::app
