// The weight files of a tracker, validated.
#pragma once

#include <mien/mien.h>

#include "engine/model.h"

namespace mien::tracker {

struct Models {
  engine::Model basenet;
  engine::Model hifinet;  // only if there is one
  engine::Model proposal;
  engine::Model audionet;  // only if there is one
  bool has_hifinet = false;
  bool has_audionet = false;
};

[[nodiscard]] mien_status open_models(const mien_tracker_config& config, Models& models);

}  // namespace mien::tracker
