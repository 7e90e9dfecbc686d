// The camera and the microphone of a live run, which can be replaced during the run.
#pragma once

#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <string>

#include "apps/mien/live/camera.h"
#include "apps/mien/live/microphone.h"

namespace mien::app {

struct InputState {
  std::string name;
  std::string error;  // why there is no input; empty: there is
};

class LiveInputs {
 public:
  // "none" stands for no input. `retries`: a camera that is missing at the start is retried. The
  // tracker must outlive this object. Throws Failure.
  LiveInputs(const std::string& camera, const std::string& microphone, bool retries,
             Tracker& tracker);

  void start(std::int64_t begin_ns);
  // Close the old device and start the new one, which is retried. Throw Failure if ffmpeg is
  // missing or the name is invalid.
  void set_camera(const std::string& name);
  void set_microphone(const std::string& name);

  [[nodiscard]] bool has_camera() const { return camera_state_.name != kNoInput; }
  [[nodiscard]] bool has_microphone() const { return microphone_ != nullptr; }
  [[nodiscard]] bool microphone_ended() { return microphone_ && microphone_->ended(); }
  [[nodiscard]] Camera& camera() { return *camera_; }
  [[nodiscard]] const std::string& camera_name() const { return camera_state_.name; }
  [[nodiscard]] const std::string& microphone_name() const { return microphone_state_.name; }
  // Include the current error.
  [[nodiscard]] const InputState& camera_state();
  [[nodiscard]] const InputState& microphone_state();
  // The number of images that all cameras so far have dropped.
  [[nodiscard]] std::uint64_t dropped() { return dropped_before_ + camera_->dropped(); }

  static constexpr const char* kNoInput = "none";

 private:
  void open_microphone();

  Tracker& tracker_;
  InputState camera_state_, microphone_state_;
  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Microphone> microphone_;  // null: no audio
  std::uint64_t dropped_before_ = 0;
};

}  // namespace mien::app
