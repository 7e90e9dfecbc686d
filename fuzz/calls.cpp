// Creates trackers with synthetic weights and checks their results.
#include "fuzz/calls.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fuzz/bytes.h"
#include "tests/tracker/blob_weights.h"

namespace mien::fuzz {

mien_tracker* make_tracker(std::int32_t max_faces) {
  static const mien_weights* weights = [] {
    const tests::AlignedBytes files[] = {tests::blob_basenet(), tests::blob_hifinet(),
                                         tests::blob_proposal(), tests::blob_audionet()};
    mien_weights_config config;
    mien_weights_config_default(&config);
    config.copy = 1;
    for (std::size_t i = 0; i < std::size(files); ++i) {
      config.files[i] = files[i].get().data();
      config.file_bytes[i] = files[i].get().size();
    }
    mien_weights* created = nullptr;
    require(mien_weights_create(&config, &created, nullptr) == MIEN_OK);
    return created;
  }();
  mien_tracker_config config;
  mien_tracker_config_default(&config);
  config.weights = weights;
  config.proposal_size = 64;
  config.max_faces = max_faces;
  config.audio_queue_samples = 4096;
  mien_tracker* tracker = nullptr;
  require(mien_tracker_create(&config, &tracker, nullptr) == MIEN_OK);
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
