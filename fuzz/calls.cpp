#include "fuzz/calls.h"

#include <algorithm>
#include <cmath>

#include "fuzz/bytes.h"
#include "tests/tracker/blob_weights.h"

namespace mien::fuzz {

mien_tracker* make_tracker(std::int32_t max_faces) {
  static const tests::AlignedBytes basenet = tests::blob_basenet(), hifinet = tests::blob_hifinet(),
                                   proposal = tests::blob_proposal(),
                                   audionet = tests::blob_audionet();
  mien_tracker_config config;
  mien_tracker_config_default(&config);
  config.basenet = basenet.get().data();
  config.basenet_bytes = basenet.get().size();
  config.hifinet = hifinet.get().data();
  config.hifinet_bytes = hifinet.get().size();
  config.proposal = proposal.get().data();
  config.proposal_bytes = proposal.get().size();
  config.audionet = audionet.get().data();
  config.audionet_bytes = audionet.get().size();
  config.proposal_size = 64;
  config.max_faces = max_faces;
  config.audio_queue_samples = 4096;
  mien_tracker* tracker = nullptr;
  require(mien_tracker_create(&config, &tracker) == MIEN_OK);
  return tracker;
}

void require_valid(const mien_result& result) {
  const auto unit = [](float value) { return value >= 0.0f && value <= 1.0f; };
  require(result.status >= MIEN_FACE_SEARCHING && result.status <= MIEN_FACE_LOST);
  require(unit(result.face_probability) && unit(result.voice_activity));
  require(std::all_of(result.controls, result.controls + MIEN_CONTROL_COUNT, unit));
  require(std::all_of(result.box, result.translation + 3,
                      [](float value) { return std::isfinite(value); }));
  for (const auto& point : result.landmarks) {
    require(std::isfinite(point[0]) && std::isfinite(point[1]));
  }
  require(result.lod >= 1 && result.lod <= 4);
}

}  // namespace mien::fuzz
