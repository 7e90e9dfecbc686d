// Loads weights and creates a tracker.
#include "apps/mien/tracking/loaded_tracker.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/networks/tiers.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

std::uint64_t now_ns(void*) {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                    std::chrono::nanoseconds(1));
}

std::string hifinet_path(const std::string& folder) { return folder + "/hifinet.mien"; }

std::string audionet_path(const std::string& models) {
  return models_directory(models) + "/audionet.mien";
}

// The weight files that the options need; HiFiNet only if it is there.
std::vector<std::string> weight_paths(const LoadedTracker::Options& options) {
  const std::string folder = models_directory(options.models);
  std::vector<std::string> paths = {folder + "/basenet.mien", folder + "/proposal.mien"};
  if (model_exists(hifinet_path(folder))) {
    paths.push_back(hifinet_path(folder));
  }
  if (options.sound) {
    paths.push_back(audionet_path(options.models));
  }
  return paths;
}

}  // namespace

bool has_audionet(const std::string& models) { return model_exists(audionet_path(models)); }

LoadedTracker::LoadedTracker(const Options& options)
    : weights(weight_paths(options)),
      has_hifinet(model_exists(hifinet_path(models_directory(options.models)))),
      has_audio(options.sound) {
  const std::string folder = models_directory(options.models);
  Config config(weights.weights());
  config.lod = options.lod.value_or(has_hifinet ? 4 : 1);
  config.budget_ms = options.budget_ms;
  config.max_faces = options.max_faces;
  config.voice_strength = options.voice_strength;
  config.horizontal_fov = options.fov_degrees * std::numbers::pi_v<float> / 180.0f;
  config.smoothing = options.unfiltered ? 0 : 1;
  config.cpu_mask = cpu_mask(options.tier, options.unfused);
  config.audio_queue_samples = options.queued_samples;
  config.clock_ns = now_ns;
  Error error;
  mien_status status = tracker.create(config, &error);
  if (status == MIEN_OK) {
    status = mien_tracker_required_bytes(&config, &tracker_bytes, &error);
  }
  if (status == MIEN_ERROR_UNSUPPORTED_LOD && !has_hifinet) {
    throw Failure(kExitUsage,
                  "--lod " + std::to_string(config.lod) + ": " + folder + " has no hifinet.mien");
  }
  if (status != MIEN_OK) {
    const std::string& where = error.file < 0 ? folder : weights.path_of(error);
    throw Failure(kExitModel, where + ": " + error.message());
  }
}

void check(mien_status status, const std::string& where) {
  if (status != MIEN_OK) {
    throw Failure(kExitInternal, where + ": " + message(status));
  }
}

std::vector<Result> results(const Tracker& tracker, const std::string& where) {
  std::vector<Result> faces(static_cast<std::size_t>(std::max(1, tracker.face_count())));
  check(tracker.get_result(faces.front()), where);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    check(tracker.get_face(static_cast<std::int32_t>(i), faces[i]), where);
  }
  return faces;
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
