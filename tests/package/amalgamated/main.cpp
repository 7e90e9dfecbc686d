// Tracks video and audio on every tier of this CPU, and prints a checksum of all results of each:
// two builds of the same library print the same.
//
// usage: amalgamated MODELS_FOLDER FRAMES.rgb       (640x480)
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "mien.h"

namespace {

constexpr int kWidth = 640, kHeight = 480, kRate = 16000, kFrames = 30;
constexpr std::size_t kFrameBytes = std::size_t{kWidth} * kHeight * 3;

struct File {
  explicit File(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    data.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  std::vector<char> data;
};

mien_weights* open_weights(const std::string& models) {
  const File files[] = {File(models + "/basenet.mien"), File(models + "/proposal.mien"),
                        File(models + "/hifinet.mien"), File(models + "/audionet.mien")};
  mien_weights_config config;
  mien_weights_config_default(&config);
  config.copy = 1;
  for (int i = 0; i < 4; ++i) {
    config.files[i] = files[i].data.data();
    config.file_bytes[i] = files[i].data.size();
  }
  mien_weights* weights = nullptr;
  mien_error_detail error;
  mien_error_detail_default(&error);
  if (mien_weights_create(&config, &weights, &error) != MIEN_OK) {
    char text[256];
    mien_error_message(&error, text, sizeof text);
    std::fprintf(stderr, "%s: %s\n", models.c_str(), text);
  }
  return weights;
}

// FNV-1a hash of all fields of a result.
struct Checksum {
  void add(const void* data, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
      value = (value ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3u;
    }
  }
  std::uint64_t value = 0xcbf29ce484222325u;
};

float buzz(int sample) {  // a tone that rises and falls like syllables
  const float t = static_cast<float>(sample) / kRate;
  float sum = 0;
  for (int k = 1; k < 20; ++k) {
    sum += std::sin(6.2831853f * 120.0f * static_cast<float>(k) * t) / static_cast<float>(k);
  }
  return 0.2f * sum * std::fmax(std::sin(6.2831853f * 4.0f * t), 0.0f);
}

bool track(const mien_weights* weights, const File& pictures, std::uint32_t tiers) {
  mien_tracker_config config;
  mien_tracker_config_default(&config);
  config.cpu_mask = tiers | MIEN_CPU_FUSED;
  config.lod = 4;
  config.weights = weights;
  mien_tracker* tracker = nullptr;
  if (mien_tracker_create(&config, &tracker, nullptr) != MIEN_OK) {
    return false;
  }
  Checksum checksum;
  int with_face = 0;
  float loudest = 0;
  const int frames = tiers == MIEN_CPU_REF ? 2 : kFrames;  // which is slow
  for (int i = 0; i < frames; ++i) {
    constexpr int kBlock = kRate / 30;
    float sound[kBlock];
    for (int k = 0; k < kBlock; ++k) {
      sound[k] = buzz(i * kBlock + k);
    }
    const std::int64_t time_ns = i * 1000000000LL / 30;
    mien_audio audio;
    mien_audio_default(&audio);
    audio.sample_rate = kRate;
    audio.frames = kBlock;
    audio.samples[0] = sound;
    mien_image image;
    mien_image_default(&image);
    image.format = MIEN_IMAGE_RGB;
    image.width = kWidth, image.height = kHeight;
    image.row_stride_bytes[0] = kWidth * 3;
    image.planes[0] = pictures.data.data() + static_cast<std::size_t>(i) * kFrameBytes;
    mien_result result;
    mien_result_default(&result);
    if (mien_tracker_push_audio(tracker, &audio, time_ns) != MIEN_OK ||
        mien_tracker_push_video(tracker, &image, time_ns) != MIEN_OK ||
        mien_tracker_get_result(tracker, &result) != MIEN_OK) {
      return false;
    }
    checksum.add(&result, sizeof result);
    with_face += result.status == MIEN_FACE_TRACKING;
    loudest = std::fmax(loudest, result.voice_activity);
  }
  mien_tracker_destroy(tracker);
  std::printf("%016llx %d of %d frames with a face, voice %.2f\n",
              static_cast<unsigned long long>(checksum.value), with_face, frames,
              static_cast<double>(loudest));
  return with_face == frames;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    return 2;
  }
  const File pictures(arguments[2]);
  if (pictures.data.size() < kFrames * kFrameBytes) {
    std::fprintf(stderr, "%s: no %d pictures\n", arguments[2], kFrames);
    return 2;
  }
  mien_weights* weights = open_weights(arguments[1]);
  bool fine = weights != nullptr && mien_cpu_tiers() != 0;
  for (std::uint32_t tier = 1; tier != 0 && tier != MIEN_CPU_FUSED; tier <<= 1) {
    if ((mien_cpu_tiers() & tier) != 0) {
      std::printf("%s ", mien_cpu_tier_name(tier));
      // Other tiers supply the kernels that a tier lacks.
      std::uint32_t below = tier == MIEN_CPU_AVX512        ? MIEN_CPU_AVX2
                            : tier == MIEN_CPU_AVX512_FP16 ? MIEN_CPU_AVX512 | MIEN_CPU_AVX2
                                                           : 0u;
      below |= tier == MIEN_CPU_AVX512_VNNI ? MIEN_CPU_AVX512 | MIEN_CPU_AVX2 : 0u;
      below |= tier == MIEN_CPU_AVX2_INT16 || tier == MIEN_CPU_AVX_VNNI ? MIEN_CPU_AVX2 : 0u;
      below |= tier == MIEN_CPU_NEON_FP16 || tier == MIEN_CPU_NEON_DOT || tier == MIEN_CPU_NEON_I8MM
                   ? MIEN_CPU_NEON
                   : 0u;
      fine = fine && track(weights, pictures, tier | below);
    }
  }
  mien_weights_destroy(weights);
  return fine ? 0 : 1;
}
