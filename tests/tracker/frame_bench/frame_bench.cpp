// Measures the time of a frame at level 4 and prints one line of JSON. The same source runs as
// WebAssembly, so that both can be compared on the same frames.
//
// usage: mien_frame_bench MODELS FRAMES WIDTH HEIGHT TIER
//
// FRAMES: raw NV12 of video range. The frames are pushed three times; the first time warms up.
#include <mien/mien.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "kernels/tier.h"

namespace {

constexpr int kRounds = 3;
constexpr std::int64_t kFrameNs = 33'333'333;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "mien_frame_bench: %s\n", what.c_str());
  std::exit(1);
}

void check(mien_status status) {
  if (status != MIEN_OK) {
    fail(mien::message(status));
  }
}

std::vector<char> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (bytes.empty()) {
    fail(path + ": cannot be read, or empty");
  }
  return bytes;
}

// The tier, the fp32 tiers that it extends, and fused blocks.
std::uint32_t cpu_mask_of(const std::string& name) {
  for (std::uint32_t i = 0; i < mien::kernels::kTierCount; ++i) {
    const auto tier = static_cast<mien::kernels::Tier>(i);
    if (name == mien::kernels::name(tier) && (mien_cpu_tiers() & mien::kernels::bit(tier)) != 0) {
      return mien::kernels::up_to(tier) | MIEN_CPU_FUSED;
    }
  }
  fail("tier '" + name + "' is not available here");
}

struct Clip {
  std::vector<char> bytes;
  int width, height;

  [[nodiscard]] std::size_t frame_bytes() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3 / 2;
  }
  [[nodiscard]] std::size_t frames() const { return bytes.size() / frame_bytes(); }
  [[nodiscard]] mien::Image frame(std::size_t index) const {
    mien::Image image;
    image.format = MIEN_IMAGE_NV12;
    image.width = width;
    image.height = height;
    image.full_range = 0;
    image.planes[0] = bytes.data() + index * frame_bytes();
    image.planes[1] = bytes.data() + index * frame_bytes() +
                      static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    image.row_stride_bytes[0] = image.row_stride_bytes[1] = width;
    return image;
  }
};

// The time of the fastest round for every frame, sorted, ms.
std::vector<double> frame_times(mien::Tracker& tracker, const Clip& clip, double& controls) {
  std::vector<double> fastest(clip.frames(), 1e9);
  for (int round = 0; round < kRounds; ++round) {
    check(tracker.reset());
    controls = 0.0;
    for (std::size_t i = 0; i < clip.frames(); ++i) {
      const mien::Image image = clip.frame(i);
      const auto begin = std::chrono::steady_clock::now();
      check(tracker.push_video(image, static_cast<std::int64_t>(i) * kFrameNs));
      const std::chrono::duration<double, std::milli> spent =
          std::chrono::steady_clock::now() - begin;
      fastest[i] = round == 0 ? 1e9 : std::min(fastest[i], spent.count());
      mien::Result result;
      check(tracker.get_result(result));
      for (const float control : result.controls) {
        controls += static_cast<double>(control);
      }
    }
  }
  std::sort(fastest.begin(), fastest.end());
  return fastest;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    fail("usage: mien_frame_bench MODELS FRAMES WIDTH HEIGHT TIER");
  }
  const mien::LoadedWeights loaded = mien::load_weights(argv[1]);
  if (!loaded) {
    fail(loaded.message);
  }
  const Clip clip{read_file(argv[2]), std::atoi(argv[3]), std::atoi(argv[4])};
  mien::Config config(loaded.weights);
  config.audio = 0;
  config.cpu_mask = cpu_mask_of(argv[5]);
  config.lod = 4;
  mien::Tracker tracker;
  check(tracker.create(config));
  double controls = 0.0;
  const std::vector<double> ms = frame_times(tracker, clip, controls);
  std::printf(
      "{\"tier\": \"%s\", \"frames\": %zu, \"min_ms\": %.4f, \"median_ms\": %.4f, "
      "\"p95_ms\": %.4f, \"sum_of_controls\": %.4f}\n",
      argv[5], ms.size(), ms.front(), ms[ms.size() / 2], ms[ms.size() * 95 / 100], controls);
}
