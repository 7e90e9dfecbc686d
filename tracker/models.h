// The weight files of a tracker, validated.
#pragma once

#include <mien/mien.h>

#include "engine/model.h"

namespace mien::tracker {

struct Models {
  engine::Model basenet;
  engine::Model hifinet;  // only if there is one
  engine::Model proposal;
  bool has_hifinet = false;
};

[[nodiscard]] mien_status open_models(const mien_tracker_config& config, Models& models);

}  // namespace mien::tracker
