// The validated weight files of a tracker.
#pragma once

#include <mien/mien.h>

#include "engine/model.h"

namespace mien::tracker {

struct Models {
  engine::Model basenet;
  engine::Model hifinet;  // only if has_hifinet
  engine::Model proposal;
  engine::Model audionet;  // only if has_audionet
  bool has_hifinet = false;
  bool has_audionet = false;
};

[[nodiscard]] mien_status open_models(const mien_tracker_config& config, Models& models);

}  // namespace mien::tracker
