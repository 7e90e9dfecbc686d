// Tests of AudioNet's optional jaw decoder, with networks whose outputs are known.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "audio/audio_net.h"
#include "audio/loudness.h"
#include "engine/arena.h"
#include "engine/network.h"
#include "formats/mien_writer.h"
#include "kernels/tier.h"
#include "tests/tracker/blob_weights.h"

namespace mien::tests {
namespace {

using audio::AudioNet;
using audio::FrontEnd;
using audio::kBands;
using audio::kSpeechControls;
using audio::Loudness;
using audio::Speech;
using engine::Arena;
using formats::Array;
using formats::LayerIndex;
using formats::MienWriter;
using formats::NetworkWriter;
using Energies = std::array<float, kBands>;

constexpr std::uint32_t kEmbedding = 80;
constexpr std::uint32_t kJawInputs = kEmbedding + kBands;
constexpr float kSilence = -18.420681f;

// outputs x inputs weights that are 0 but for `gain` at [0, input].
Array selecting(std::uint32_t outputs, std::uint32_t inputs, std::uint32_t input, float gain) {
  Array weight = {{outputs, inputs}, std::vector<float>(std::size_t{outputs} * inputs, 0.0f)};
  weight.values[input] = gain;
  return weight;
}

LayerIndex add_dense(NetworkWriter& network, const Array& weight, float bias) {
  return network.fully_connected(NetworkWriter::kInput, weight,
                                 std::vector<float>(weight.shape[0], bias));
}

void add_network(MienWriter& writer, const std::string& name, const Array& weight, float bias) {
  NetworkWriter& network = writer.network(name, {1, 1, weight.shape[1]});
  network.output(add_dense(network, weight, bias));
}

// Embedding 0 is feature 0. Its double is the jawOpen of the controls decoder.
void add_parts_without_jaw(MienWriter& writer) {
  add_network(writer, "encoder", selecting(kEmbedding, FrontEnd::kFeatures, 0, 1.0f), 0.0f);
  add_network(writer, "controls_decoder", selecting(kSpeechControls, kEmbedding, 0, 2.0f), 0.25f);
  NetworkWriter& activity = writer.network("activity_decoder", {1, 1, kEmbedding});
  activity.output(activity.softmax(add_dense(activity, selecting(2, kEmbedding, 0, 1.0f), 0.0f)));
}

AlignedBytes finished(const MienWriter& writer) {
  std::vector<std::byte> file;
  if (writer.finish(&file).status != MIEN_OK) {
    std::abort();
  }
  return AlignedBytes(file);
}

AlignedBytes without_jaw() {
  MienWriter writer;
  add_parts_without_jaw(writer);
  return finished(writer);
}

AlignedBytes with_jaw(const Array& weight, float bias = 0.0f) {
  MienWriter writer;
  add_parts_without_jaw(writer);
  add_network(writer, "jaw_decoder", weight, bias);
  return finished(writer);
}

// An AudioNet with its weights and memory.
class LoadedNet {
 public:
  explicit LoadedNet(const AlignedBytes& file) : file_(file.get()) {
    EXPECT_EQ(model_.open(file_.get()).status, MIEN_OK);
    Arena measuring;
    status_ = net_.load(model_, kernels::detect_cpu(), measuring);
    if (status_ != MIEN_OK) {
      return;
    }
    memory_ = AlignedBytes(std::vector<std::byte>(measuring.need().total_bytes()));
    Arena arena(const_cast<std::byte*>(memory_.get().data()), measuring.need());
    status_ = net_.load(model_, kernels::detect_cpu(), arena);
    net_.reset();
  }

  [[nodiscard]] mien_status status() const { return status_; }
  AudioNet& net() { return net_; }

  Speech process(float feature, float energy, std::size_t band = 0, float extra = 0.0f) {
    std::array<float, FrontEnd::kFeatures> features = {};
    features[0] = feature;
    Energies energies;
    energies.fill(energy);
    energies[band] += extra;
    return net_.process(features, energies);
  }

 private:
  AlignedBytes file_;
  AlignedBytes memory_ = AlignedBytes({});
  engine::Model model_;
  AudioNet net_;
  mien_status status_ = MIEN_OK;
};

TEST(JawDecoder, FilesWithoutOneIgnoreTheEnergies) {
  LoadedNet quiet(without_jaw()), loud(without_jaw());
  ASSERT_EQ(quiet.status(), MIEN_OK);
  for (const float feature : {0.0f, 0.125f, 0.25f}) {
    const Speech a = quiet.process(feature, kSilence), b = loud.process(feature, 3.0f);
    EXPECT_EQ(a.controls, b.controls);
    EXPECT_FLOAT_EQ(a.controls[0], 2.0f * feature + 0.25f);
  }
}

TEST(JawDecoder, ReplacesJawOpenOnly) {
  LoadedNet plain(without_jaw()), jaw(with_jaw(selecting(1, kJawInputs, 0, 1.0f), 0.5f));
  ASSERT_EQ(jaw.status(), MIEN_OK);
  Speech expected = plain.process(0.125f, 0.0f);
  const Speech got = jaw.process(0.125f, 0.0f);
  EXPECT_EQ(expected.activity, got.activity);
  expected.controls[0] = 0.625f;
  EXPECT_EQ(expected.controls, got.controls);
}

TEST(JawDecoder, ReadsEnergiesAboveTheLevelAfterTheEmbedding) {
  constexpr std::uint32_t kBand = 7;
  constexpr float kGain = 0.0625f, kEnergy = -10.0f, kExtra = 4.0f;
  LoadedNet jaw(with_jaw(selecting(1, kJawInputs, kEmbedding + kBand, kGain)));
  const float mean = kEnergy + kExtra / kBands;
  const float level = kSilence + (mean - kSilence) / Loudness::kAttack;
  for (int round = 0; round < 2; ++round) {  // the second one after a reset
    jaw.net().reset();
    const Speech same_band = jaw.process(0.0f, kEnergy, kBand, kExtra);
    EXPECT_NEAR(same_band.controls[0], kGain * (kEnergy + kExtra - level), 1e-3f);
    jaw.net().reset();
    const Speech other_band = jaw.process(0.0f, kEnergy, kBand + 1, kExtra);
    EXPECT_NEAR(other_band.controls[0], kGain * (kEnergy - level), 1e-3f);
  }
}

TEST(JawDecoder, RejectsOtherShapes) {
  for (const auto& [outputs, inputs] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, kEmbedding},
                                                            {1, kBands},
                                                            {1, kJawInputs - 1},
                                                            {1, kJawInputs + 1},
                                                            {2, kJawInputs}}) {
    LoadedNet net(with_jaw(selecting(outputs, inputs, 0, 1.0f)));
    EXPECT_EQ(net.status(), MIEN_ERROR_WEIGHTS_SHAPE) << outputs << " of " << inputs;
  }
}

// The relative energies of the last of `windows` windows with the same energy in all bands.
float relative_after(int windows, float energy) {
  Loudness loudness;
  loudness.reset();
  Energies energies, relative = {};
  energies.fill(energy);
  for (int window = 0; window < windows; ++window) {
    loudness.subtract(energies, relative);
  }
  return relative[0];
}

TEST(Loudness, CancelsTheLevelOfSteadyAudio) {
  EXPECT_NEAR(relative_after(60, -3.0f), 0.0f, 1e-3f);
  EXPECT_NEAR(relative_after(60, -12.0f), 0.0f, 1e-3f);
  EXPECT_NEAR(relative_after(1, kSilence), 0.0f, 1e-5f);
}

TEST(Loudness, FallsSlowly) {
  Loudness loudness;
  loudness.reset();
  Energies energies, relative = {};
  energies.fill(-3.0f);
  for (int window = 0; window < 100; ++window) {
    loudness.subtract(energies, relative);
  }
  energies.fill(-13.0f);
  loudness.subtract(energies, relative);
  EXPECT_NEAR(relative[0], -10.0f * (1.0f - 1.0f / Loudness::kRelease), 0.01f);
}

}  // namespace
}  // namespace mien::tests
