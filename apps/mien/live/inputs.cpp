// Opens and replaces live inputs.
#include "apps/mien/live/inputs.h"

#include <utility>

#include "apps/mien/live/advice.h"
#include "apps/mien/sources/live_source.h"

namespace mien::app {

LiveInputs::LiveInputs(const std::string& camera, const std::string& microphone, bool retries,
                       Tracker& tracker)
    : tracker_(tracker),
      camera_state_{camera, {}},
      microphone_state_{microphone, {}},
      camera_(std::make_unique<Camera>(camera, retries)) {
  open_microphone();
}

void LiveInputs::open_microphone() {
  microphone_.reset();  // closed first, because the same device may be opened again
  if (microphone_state_.name != kNoInput) {
    microphone_ = std::make_unique<Microphone>(microphone_state_.name, tracker_);
  }
}

void LiveInputs::start(std::int64_t begin_ns) {
  camera_->start(begin_ns);
  if (microphone_) {
    microphone_->start(begin_ns);
  }
}

void LiveInputs::set_camera(const std::string& name) {
  auto camera = std::make_unique<Camera>(name, true);
  dropped_before_ += camera_->dropped();
  camera_.reset();  // closed first, because the same device may be opened again
  camera_ = std::move(camera);
  camera_state_ = {name, {}};
  camera_->start(steady_now_ns());
}

void LiveInputs::set_microphone(const std::string& name) {
  microphone_state_ = {name, {}};
  open_microphone();
  if (microphone_) {
    microphone_->start(steady_now_ns());
  }
}

const InputState& LiveInputs::camera_state() {
  camera_state_.error = advised(CaptureKind::kCamera, camera_->error());
  return camera_state_;
}

const InputState& LiveInputs::microphone_state() {
  microphone_state_.error =
      microphone_ ? advised(CaptureKind::kMicrophone, microphone_->error()) : "";
  return microphone_state_;
}

}  // namespace mien::app
