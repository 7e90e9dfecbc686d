// Finds the weight files of a tracker.
#include "tracker/encoders/models.h"

namespace mien::tracker {
namespace {

// Networks that only one of the files has.
constexpr const char* kBaseNet = "face_probability";
constexpr const char* kProposal = "pnet";
constexpr const char* kAudioNet = "activity_decoder";

const mien_weights::File* find(const mien_weights& weights, const char* network) {
  for (const mien_weights::File& file : weights) {
    if (file.model.network(network) != nullptr) {
      return &file;
    }
  }
  return nullptr;
}

// BaseNet and AudioNet have encoders as well.
const mien_weights::File* find_hifinet(const mien_weights& weights) {
  for (const mien_weights::File& file : weights) {
    const engine::Model& model = file.model;
    if (model.network("encoder") != nullptr && model.network(kBaseNet) == nullptr &&
        model.network(kAudioNet) == nullptr) {
      return &file;
    }
  }
  return nullptr;
}

bool take(const mien_weights::File* file, mien_error_detail& error, engine::Model& model) {
  if (file != nullptr) {
    model = file->model;
    model.describe_errors(&error, file->index);
  }
  return file != nullptr;
}

}  // namespace

mien_status find_models(const mien_tracker_config& config, mien_error_detail& error,
                        Models& models) {
  const mien_weights& weights = *config.weights;
  for (const char* network : {kBaseNet, kProposal}) {
    const bool is_basenet = network == kBaseNet;
    if (!take(find(weights, network), error, is_basenet ? models.basenet : models.proposal)) {
      formats::describe(error, MIEN_ERROR_WEIGHTS_INCOMPLETE, "network");
      formats::set_name(error, network);
      return MIEN_ERROR_WEIGHTS_INCOMPLETE;
    }
  }
  models.has_hifinet = config.max_lod > 1 && take(find_hifinet(weights), error, models.hifinet);
  models.has_audionet = config.audio != 0 && take(find(weights, kAudioNet), error, models.audionet);
  return MIEN_OK;
}

bool has_hifinet(const mien_weights& weights) { return find_hifinet(weights) != nullptr; }

}  // namespace mien::tracker
