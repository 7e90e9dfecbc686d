// Loads weights and creates a tracker.
#include "apps/mien/tracking/loaded_tracker.h"

#include <array>
#include <chrono>
#include <fstream>
#include <numbers>
#include <span>

#include "apps/mien/networks/tiers.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

std::uint64_t now_ns(void*) {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                    std::chrono::nanoseconds(1));
}

std::optional<Blob> blob_if_there(const std::string& path) {
  return model_exists(path) ? std::optional<Blob>(path) : std::nullopt;
}

std::span<const std::byte> bytes(const Blob& blob) {
  return {static_cast<const std::byte*>(blob.data()), blob.size()};
}

std::string audionet_path(const std::string& models) {
  return models_directory(models) + "/audionet.mien";
}

}  // namespace

bool has_audionet(const std::string& models) { return model_exists(audionet_path(models)); }

LoadedTracker::LoadedTracker(const Options& options)
    : basenet(models_directory(options.models) + "/basenet.mien"),
      proposal(models_directory(options.models) + "/proposal.mien"),
      hifinet(blob_if_there(models_directory(options.models) + "/hifinet.mien")) {
  if (options.sound) {
    audionet.emplace(audionet_path(options.models));
  }
  Config config(bytes(basenet), bytes(proposal));
  if (hifinet) {
    config.hifinet = hifinet->data();
    config.hifinet_bytes = hifinet->size();
  }
  if (audionet) {
    config.audionet = audionet->data();
    config.audionet_bytes = audionet->size();
  }
  config.lod = options.lod.value_or(hifinet ? 4 : 1);
  config.budget_ms = options.budget_ms;
  config.max_faces = options.max_faces;
  config.voice_strength = options.voice_strength;
  config.horizontal_fov = options.fov_degrees * std::numbers::pi_v<float> / 180.0f;
  config.smoothing = options.unfiltered ? 0 : 1;
  config.cpu_mask = cpu_mask(options.tier, options.unfused);
  config.audio_queue_samples = options.queued_samples;
  config.clock_ns = now_ns;
  mien_status status = tracker.create(config);
  if (status == MIEN_OK) {
    status = mien_tracker_required_bytes(&config, &tracker_bytes);
  }
  if (status == MIEN_ERROR_UNSUPPORTED_LOD) {
    throw Failure(kExitUsage, "--lod " + std::to_string(config.lod) + ": " +
                                  models_directory(options.models) + " has no hifinet.mien");
  }
  if (status != MIEN_OK) {
    throw Failure(kExitModel, models_directory(options.models) + ": " + message(status));
  }
}

void check(mien_status status, const std::string& where) {
  if (status != MIEN_OK) {
    throw Failure(kExitInternal, where + ": " + message(status));
  }
}

void load_neutral(const std::string& path, Tracker& tracker) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, MIEN_NEUTRAL_BYTES + 1> bytes;  // one more, to detect a file that is too long
  file.read(bytes.data(), bytes.size());
  if (file.bad() || file.gcount() == 0) {
    throw Failure(kExitNoInput, path + ": cannot be read");
  }
  const mien_status status = tracker.load_neutral(
      std::as_bytes(std::span(bytes).first(static_cast<std::size_t>(file.gcount()))));
  if (status == MIEN_ERROR_SEVERAL_FACES) {
    throw Failure(kExitUsage, std::string("--neutral with --max-faces: ") + message(status));
  }
  if (status != MIEN_OK) {
    throw Failure(kExitNoInput, path + ": " + message(status));
  }
}

}  // namespace mien::app
