// Formats the screen of `mien live`.
#include "apps/mien/live/screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "apps/animation/numbers.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/tracking/part_times.h"

namespace mien::app {
namespace {

constexpr std::size_t kColumns = 80;
constexpr std::size_t kLabelColumns = 12;
constexpr std::size_t kNameColumns = 16;
constexpr std::size_t kBarCells = 20;

// The main controls in two columns; the person's left is on the left, as in a mirror.
constexpr std::array<std::array<std::string_view, 2>, 7> kBars = {{
    {"eyeBlinkLeft", "eyeBlinkRight"},
    {"browDownLeft", "browDownRight"},
    {"browInnerUp", "cheekPuff"},
    {"jawOpen", "mouthClose"},
    {"mouthSmileLeft", "mouthSmileRight"},
    {"mouthPucker", "mouthFunnel"},
    {"mouthFrownLeft", "mouthFrownRight"},
}};

std::string padded(std::string_view text, std::size_t columns) {
  std::string result(text.substr(0, columns));
  return result + std::string(columns - result.size(), ' ');
}

std::string bar(double value) {
  const auto cells = static_cast<std::size_t>(
      std::lround(std::clamp(value, 0.0, 1.0) * static_cast<double>(kBarCells)));
  return std::string(cells, '#') + std::string(kBarCells - cells, '.');
}

std::string degrees(double radians) {
  const long whole = std::lround(radians * 180.0 / std::numbers::pi);
  return std::to_string(whole);
}

std::string line(const std::string& text) { return text.substr(0, kColumns) + "\n"; }

std::string labelled(std::string_view label, const std::string& text) {
  return line(padded(label, kLabelColumns) + text);
}

std::string face_line(const animation::Frame& frame) {
  std::string text = name(frame.state);
  if (frame.head) {
    text += ", pitch " + degrees(frame.head->pitch) + ", yaw " + degrees(frame.head->yaw) +
            ", roll " + degrees(frame.head->roll) + " degrees";
  }
  return text;
}

std::string bars(const animation::Frame& frame) {
  std::string text;
  for (const auto& row : kBars) {
    std::string both;
    for (const std::string_view name : row) {
      const double value = frame.controls[formats::index_of(name, formats::kArkitNames)];
      both += padded(name, kNameColumns) +
              (formats::driven(value) ? bar(value) : padded("-", kBarCells));
      both += "    ";
    }
    text += line(both);
  }
  return text;
}

std::string input_text(const InputState& input) {
  return printable(input.error.empty() ? input.name : input.error + "; retrying");
}

std::string receiver_text(const ReceiverState& receiver) {
  return printable(receiver.name + (receiver.detail.empty() ? "" : ", " + receiver.detail) +
                   (receiver.paused ? ", paused" : ""));
}

}  // namespace

std::string screen_text(const ScreenState& state, const LiveStatistics& statistics) {
  std::string text = labelled("camera", input_text(state.camera)) +
                     labelled("microphone", input_text(state.microphone));
  for (const ReceiverState& receiver : state.receivers) {
    text += labelled("sends to", receiver_text(receiver));
  }
  if (state.receivers.empty()) {
    text += labelled("sends to", "no receiver");
  }
  if (!state.page.empty()) {
    text += labelled("page", state.page);
  }
  text += labelled("frames", animation::fixed(statistics.frames_per_second(), 1) +
                                 " per second, dropped: " + std::to_string(state.dropped_images) +
                                 " images, " + std::to_string(state.dropped_packets) + " packets");
  text += labelled("level", std::to_string(state.level) + (state.automatic ? " (automatic)" : "") +
                                (state.mirrored ? ", mirrored" : ""));
  text += labelled("tracking", part_times(statistics.stage_ms(), 1));
  text += labelled("latency", animation::fixed(statistics.latency().quantile(0.5), 1) +
                                  " ms from image to packet, 99 % within " +
                                  animation::fixed(statistics.latency().quantile(0.99), 1) + " ms");
  text +=
      labelled("face", state.calibrating ? "calibrating: look neutral" : face_line(state.frame));
  text += labelled("voice", bar(formats::or_zero(state.frame.voice_activity)));
  return text + "\n" + bars(state.frame) + "\n" +
         line("q quit   c calibrate   m mirror   1 2 3 4 level   a automatic level");
}

}  // namespace mien::app
