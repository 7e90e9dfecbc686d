// Defaults and validation of a tracker's configuration.
#include "tracker/api/config.h"

#include <cstdint>

#include "tracker/api/allocate.h"
#include "tracker/api/report.h"
#include "tracker/api/versioned_struct.h"
#include "tracker/audio/audio_queue.h"
#include "tracker/encoders/levels.h"
#include "tracker/encoders/models.h"

namespace mien::tracker {
namespace {

constexpr float kSixtyDegrees = 1.04719755f;

// Checks numbers in turn, until one is out of range.
class Ranges {
 public:
  explicit Ranges(mien_error_detail& error) : error_(error) {}

  [[nodiscard]] bool ok() const { return error_.status == MIEN_OK; }

  // NaN is out of range. Not inlined: the calls are many and rare.
  [[gnu::noinline]] void check(const char* field, float value, float min, float max) {
    if (ok() && !(value >= min && value <= max)) {
      formats::describe(error_, MIEN_ERROR_OUT_OF_RANGE, field, static_cast<double>(value),
                        static_cast<double>(min), static_cast<double>(max));
    }
  }
  [[gnu::noinline]] void check(const char* field, std::int32_t value, std::int32_t min,
                               std::int32_t max, mien_status status = MIEN_ERROR_OUT_OF_RANGE) {
    if (ok() && (value < min || value > max)) {
      formats::describe(error_, status, field, value, min, max);
    }
  }

 private:
  mien_error_detail& error_;
};

void check_ranges(const mien_tracker_config& c, Ranges& ranges) {
  ranges.check("max_lod", c.max_lod, kMinLevel, kMaxLevel);
  ranges.check("horizontal_fov", c.horizontal_fov, 0.01f, 3.1f);
  ranges.check("accept_probability", c.accept_probability, 0.0f, 1.0f);
  ranges.check("lose_probability", c.lose_probability, 0.0f, c.accept_probability);
  ranges.check("lose_after_frames", c.lose_after_frames, 1, 1000);
  ranges.check("proposal_size", c.proposal_size, 24, 640);
  ranges.check("proposal_threshold", c.proposal_threshold, 0.0f, 1.0f);
  ranges.check("refine_threshold", c.refine_threshold, 0.0f, 1.0f);
  ranges.check("search_interval", c.search_interval, 1, 1000);
  ranges.check("budget_ms", c.budget_ms, 0.01f, 1e6f);
  ranges.check("max_faces", c.max_faces, 1, MIEN_MAX_FACES);
  ranges.check("voice_attack_ms", c.voice_attack_ms, 0.0f, 10000.0f);
  ranges.check("voice_release_ms", c.voice_release_ms, 0.0f, 10000.0f);
  ranges.check("audio_queue_samples", c.audio_queue_samples, 0, AudioQueue::kMaxSamples);
  ranges.check("voice_strength", c.voice_strength, 0.0f, 4.0f);
}

}  // namespace

mien_status read_config(const mien_tracker_config* given, mien_tracker_config& config,
                        mien_error_detail& error) {
  if (given == nullptr) {
    return fail(error, MIEN_ERROR_NULL_ARGUMENT, "config");
  }
  mien_tracker_config_default(&config);
  if (!read_struct(*given, MIEN_SIZE_THROUGH(mien_tracker_config, weights), config)) {
    return fail(error, MIEN_ERROR_STRUCT_SIZE, "struct_size");
  }
  if (config.weights == nullptr) {
    return fail(error, MIEN_ERROR_NULL_ARGUMENT, "weights");
  }
  if (!is_valid(config.allocator)) {
    return fail(error, MIEN_ERROR_OUT_OF_RANGE, "allocator");
  }
  Ranges ranges(error);
  check_ranges(config, ranges);
  if (!has_hifinet(*config.weights)) {
    config.max_lod = kMinLevel;
  }
  ranges.check("lod", config.lod, 0, config.max_lod, MIEN_ERROR_UNSUPPORTED_LOD);
  return static_cast<mien_status>(error.status);
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
  config->max_lod = mien::tracker::kMaxLevel;
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
  config->audio = 1;
  config->voice_attack_ms = 40.0f;
  config->voice_release_ms = 150.0f;
  config->voice_strength = 1.0f;
}
