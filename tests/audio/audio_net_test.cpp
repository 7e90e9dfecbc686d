// Compares models/audionet.mien with PyTorch's outputs for the same features
// (models/training/mien_training/audio/golden_outputs.py).
#include "audio/audio_net.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "kernels/tier.h"
#include "tests/audio/golden.h"
#include "tests/kernels/every_tier.h"
#include "tests/tracker/blob_weights.h"

namespace mien::tests {
namespace {

using audio::AudioNet;
using audio::FrontEnd;
using audio::kBands;
using audio::kSpeechControls;
using audio::Speech;
using engine::Arena;

const char kModel[] = MIEN_SOURCE_DIR "/models/audionet.mien";

AlignedBytes file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return AlignedBytes(std::as_bytes(std::span(bytes)));
}

class AudioNetOfTier : public testing::TestWithParam<std::uint32_t> {
 protected:
  void SetUp() override {
    if (!std::ifstream(kModel)) {
      GTEST_SKIP() << "skipped: models/audionet.mien is not available";
    }
    const std::span<const std::byte> file = file_.get();
    ASSERT_EQ(model_.open(file).status, MIEN_OK);
    Arena measuring;
    ASSERT_EQ(net_.load(model_, GetParam(), measuring), MIEN_OK);
    memory_.resize(measuring.need().total_bytes() + Arena::kAlignment);
    auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
    address = (address + Arena::kAlignment - 1) / Arena::kAlignment * Arena::kAlignment;
    Arena arena(reinterpret_cast<std::byte*>(address), measuring.need());
    ASSERT_EQ(net_.load(model_, GetParam(), arena), MIEN_OK);
    net_.reset();
  }

  AlignedBytes file_ = file_bytes(kModel);
  engine::Model model_;
  std::vector<std::byte> memory_;
  AudioNet net_;
};

TEST_P(AudioNetOfTier, MatchesPyTorch) {
  const std::vector<float> features = golden("audionet_input.f32");
  const std::vector<float> log_mel = golden("audionet_log_mel.f32");
  const std::vector<float> controls = golden("audionet_controls.f32");
  const std::vector<float> activity = golden("audionet_activity.f32");
  const std::size_t steps = features.size() / FrontEnd::kFeatures;
  ASSERT_GT(steps, 30u);
  ASSERT_EQ(log_mel.size(), steps * kBands);
  ASSERT_EQ(controls.size(), steps * kSpeechControls);
  ASSERT_EQ(activity.size(), steps * 2);
  const float tolerance = is_half(GetParam()) ? 5e-3f : 2e-5f;
  for (int round = 0; round < 2; ++round) {  // the second one after a reset
    for (std::size_t step = 0; step < steps; ++step) {
      const Speech speech =
          net_.process(std::span<const float, FrontEnd::kFeatures>(
                           features.data() + step * FrontEnd::kFeatures, FrontEnd::kFeatures),
                       std::span<const float, kBands>(log_mel.data() + step * kBands, kBands));
      for (std::size_t i = 0; i < kSpeechControls; ++i) {
        ASSERT_NEAR(speech.controls[i], controls[step * kSpeechControls + i], tolerance) << step;
      }
      ASSERT_NEAR(speech.activity, activity[2 * step + 1], tolerance) << step;
    }
    net_.reset();
  }
}

INSTANTIATE_TEST_SUITE_P(Tiers, AudioNetOfTier, testing::ValuesIn(every_tier()));

}  // namespace
}  // namespace mien::tests
