// Opens and validates the weight files of a tracker.
#include "tracker/encoders/models.h"

#include "engine/network.h"

namespace mien::tracker {

mien_status open_models(const mien_tracker_config& config, Models& models) {
  mien_status status = engine::open_model(config.basenet, config.basenet_bytes, models.basenet);
  models.has_hifinet = config.hifinet != nullptr;
  if (status == MIEN_OK && models.has_hifinet) {
    status = engine::open_model(config.hifinet, config.hifinet_bytes, models.hifinet);
  }
  models.has_audionet = config.audionet != nullptr;
  if (status == MIEN_OK && models.has_audionet) {
    status = engine::open_model(config.audionet, config.audionet_bytes, models.audionet);
  }
  return status == MIEN_OK
             ? engine::open_model(config.proposal, config.proposal_bytes, models.proposal)
             : status;
}

}  // namespace mien::tracker
