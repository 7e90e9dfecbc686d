// The weight files of a tracker.
#pragma once

#include <mien/mien.h>

#include "engine/model.h"
#include "tracker/encoders/weights.h"

namespace mien::tracker {

struct Models {
  engine::Model basenet;
  engine::Model hifinet;  // only if has_hifinet
  engine::Model proposal;
  engine::Model audionet;  // only if has_audionet
  bool has_hifinet = false;
  bool has_audionet = false;
};

// Finds the files among the weights by their networks. Errors of loading them are described in
// `error`.
// Returns MIEN_OK, or MIEN_ERROR_WEIGHTS_INCOMPLETE without BaseNet or the detector.
[[nodiscard]] mien_status find_models(const mien_tracker_config& config, mien_error_detail& error,
                                      Models& models);

// Whether the weights have HiFiNet.
[[nodiscard]] bool has_hifinet(const mien_weights& weights);

}  // namespace mien::tracker
