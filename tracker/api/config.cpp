// Defaults and validation of a tracker's configuration.
#include "tracker/api/config.h"

#include <cstdint>

#include "tracker/api/versioned_struct.h"
#include "tracker/audio/audio_queue.h"
#include "tracker/encoders/levels.h"

namespace mien::tracker {
namespace {

constexpr float kSixtyDegrees = 1.04719755f;

// NaN fails these comparisons.
bool within(float value, float low, float high) { return value >= low && value <= high; }
bool within(std::int32_t value, std::int32_t low, std::int32_t high) {
  return value >= low && value <= high;
}

bool in_range(const mien_tracker_config& c) {
  return within(c.horizontal_fov, 0.01f, 3.1f) && within(c.accept_probability, 0.0f, 1.0f) &&
         within(c.lose_probability, 0.0f, c.accept_probability) &&
         within(c.lose_after_frames, 1, 1000) && within(c.proposal_size, 24, 640) &&
         within(c.proposal_threshold, 0.0f, 1.0f) && within(c.refine_threshold, 0.0f, 1.0f) &&
         within(c.search_interval, 1, 1000) && within(c.budget_ms, 0.01f, 1e6f) &&
         within(c.max_faces, 1, MIEN_MAX_FACES) && within(c.voice_attack_ms, 0.0f, 10000.0f) &&
         within(c.voice_release_ms, 0.0f, 10000.0f) &&
         within(c.audio_queue_samples, 0, AudioQueue::kMaxSamples) &&
         within(c.voice_strength, 0.0f, 4.0f) &&
         (c.allocator.allocate == nullptr) == (c.allocator.release == nullptr);
}

bool aligned(const void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory) % MIEN_ALIGNMENT == 0;
}

}  // namespace

mien_status read_config(const mien_tracker_config* given, mien_tracker_config& config) {
  if (given == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  mien_tracker_config_default(&config);
  if (!read_struct(*given, MIEN_SIZE_THROUGH(mien_tracker_config, proposal_bytes), config)) {
    return MIEN_ERROR_STRUCT_SIZE;
  }
  if (config.basenet == nullptr || config.proposal == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (!aligned(config.basenet) || !aligned(config.hifinet) || !aligned(config.proposal) ||
      !aligned(config.audionet)) {
    return MIEN_ERROR_ALIGNMENT;
  }
  if (!within(config.lod, 0, config.hifinet != nullptr ? kHighestLevel : kLowestLevel)) {
    return MIEN_ERROR_UNSUPPORTED_LOD;
  }
  return in_range(config) ? MIEN_OK : MIEN_ERROR_OUT_OF_RANGE;
}

}  // namespace mien::tracker

void mien_tracker_config_default(mien_tracker_config* config) {
  if (config == nullptr) {
    return;
  }
  *config = {};
  config->struct_size = sizeof *config;
  config->cpu_mask = MIEN_CPU_ALL;
  config->lod = 1;
  config->horizontal_fov = mien::tracker::kSixtyDegrees;
  config->accept_probability = 0.999f;
  config->lose_probability = 0.5f;
  config->lose_after_frames = 3;
  config->proposal_size = 160;
  config->proposal_threshold = 0.4f;
  config->refine_threshold = 0.2f;
  config->search_interval = 3;
  config->budget_ms = 10.0f;
  config->smoothing = 1;
  config->max_faces = 1;
  config->voice_attack_ms = 40.0f;
  config->voice_release_ms = 150.0f;
  config->voice_strength = 1.0f;
}
