// Temporal networks: the outputs of a stream step by step equal those of the whole stream at once,
// sessions are independent, and a reset clears all state.
#include <algorithm>
#include <cfloat>
#include <cstring>
#include <numeric>

#include "tests/engine/twin_session.h"

namespace mien::tests {
namespace {

using engine::Session;
using formats::Array;
using formats::LayerActivation;

constexpr std::size_t kFrames = 40;

using Frames = std::vector<std::vector<float>>;

// The structure of the decoders: causal convolution, LSTM, fully connected.
class Decoder {
 public:
  explicit Decoder(unsigned seed) : twin(writer.network("net", {1, 1, 20}), {1, 1, 20}, seed) {
    TwinNetwork::Options leaky;
    leaky.activation = LayerActivation::kLeakyRelu;
    leaky.alpha = 0.25f;
    const auto x = twin.lstm(twin.causal_conv(twin.causal_conv(0, 24, leaky), 11, leaky), 16);
    twin.output(twin.fully_connected(x, 7));
  }

  std::vector<Map> random_inputs() {
    std::vector<Map> inputs;
    for (std::size_t i = 0; i < kFrames; ++i) {
      inputs.push_back(twin.random_input());
    }
    return inputs;
  }

  formats::MienWriter writer;
  TwinNetwork twin;
};

std::vector<float> run(Session& session, const Map& input) {
  set_input(session, input);
  session.run();
  const auto output = session.output(0);
  return {output.begin(), output.end()};
}

Frames run_all(Session& session, const std::vector<Map>& inputs) {
  Frames frames;
  for (const Map& input : inputs) {
    frames.push_back(run(session, input));
  }
  return frames;
}

// A causal convolution over all frames at once, as in training: a window of two rows over the time
// axis, with a row of zeros before the first.
TEST(Streams, FrameByFrameIsTheConvolutionOfTheWholeStream) {
  constexpr std::uint32_t kInputs = 6, kOutputs = 5;
  std::mt19937 random(4);
  const auto sixteenths = [&](std::size_t n) {
    std::vector<float> values(n);
    std::generate(values.begin(), values.end(),
                  [&] { return static_cast<float>(static_cast<int>(random() % 33) - 16) / 16.0f; });
    return values;
  };
  Map whole(kFrames, 1, kInputs);
  for (double& one : whole.values) {
    one = static_cast<double>(sixteenths(1)[0]);
  }
  const Array over_time{{kOutputs, kInputs, 2}, sixteenths(kOutputs * kInputs * 2)};
  const Array as_image{{kOutputs, kInputs, 2, 1}, over_time.values};
  formats::LayerOptions options;
  options.padding = {1, 0, 0, 0};
  const Map want = plain_conv(whole, as_image, Bias(kOutputs), options);

  formats::MienWriter writer;
  formats::NetworkWriter& network = writer.network("net", {1, 1, kInputs});
  network.output(network.causal_conv(0, over_time, {}));
  OwnedSession engine(finished(writer), "net");
  ASSERT_EQ(engine.status, MIEN_OK);
  for (std::size_t t = 0; t < kFrames; ++t) {
    Map frame(1, 1, kInputs);
    std::copy_n(whole.values.begin() + static_cast<std::ptrdiff_t>(t * kInputs), kInputs,
                frame.values.begin());
    const std::vector<float> got = run(*engine.session, frame);
    for (std::size_t c = 0; c < kOutputs;
         ++c) {  // multiples of 1/256, whose sums are exact in any order
      EXPECT_EQ(static_cast<double>(got[c]), want.at(t, 0, c)) << "frame " << t;
    }
  }
}

TEST(Streams, StayWithPlainLayersForLong) {
  for (const std::uint32_t tier : tiers_here()) {
    Decoder decoder(1);
    expect_twins_agree(decoder.writer, "net", decoder.twin, tier, 200);
  }
}

TEST(Streams, ResetMakesASessionFreshBitForBit) {
  for (const std::uint32_t tier : tiers_here()) {
    Decoder decoder(2);
    OwnedSession used(finished(decoder.writer), "net", {}, tier);
    OwnedSession fresh(finished(decoder.writer), "net", {}, tier);
    const std::vector<Map> inputs = decoder.random_inputs();
    const Frames first = run_all(*used.session, decoder.random_inputs());
    EXPECT_NE(run_all(*used.session, inputs), run_all(*fresh.session, inputs)) << "no state at all";
    used.session->reset();
    fresh.session->reset();
    OwnedSession newest(finished(decoder.writer), "net", {}, tier);
    const Frames want = run_all(*newest.session, inputs);
    EXPECT_EQ(run_all(*used.session, inputs), want);
    EXPECT_EQ(run_all(*fresh.session, inputs), want);
  }
}

TEST(Streams, SessionsTakingTurnsInOneArenaDoNotDisturbEachOther) {
  Decoder decoder(3);
  AlignedBuffer file = finished(decoder.writer);
  engine::Model model;
  ASSERT_EQ(model.open(file.span()).status, MIEN_OK);
  const engine::SessionRequest request{&model, "net", {}};
  engine::SessionSize size;
  ASSERT_EQ(engine::session_size(request, size), MIEN_OK);
  AlignedBuffer arena(size.arena_bytes),
      memories[2] = {AlignedBuffer(size.session_bytes), AlignedBuffer(size.session_bytes)};
  Session* sessions[2] = {};
  std::vector<Map> inputs[2];
  Frames together[2];
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(Session::init(request, memories[i].span(), arena.span(), sessions[i]), MIEN_OK);
    inputs[i] = decoder.random_inputs();
  }
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    for (std::size_t i = 0; i < 2; ++i) {
      together[i].push_back(run(*sessions[i], inputs[i][frame]));
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    OwnedSession alone(finished(decoder.writer), "net");
    EXPECT_EQ(run_all(*alone.session, inputs[i]), together[i]);
  }
}

// A cell that halves its value in each step decays to zero. Without a flush it would become
// denormal, and operations on denormal numbers are many times slower.
TEST(Streams, FadingStateBecomesZeroNotDenormal) {
  constexpr std::uint32_t kHidden = 8;
  formats::MienWriter writer;
  formats::NetworkWriter& network = writer.network("net", {1, 1, 8});
  Array ih{{4 * kHidden, 8}, std::vector<float>(std::size_t{4} * kHidden * 8)};
  const Array hh{{4 * kHidden, kHidden}, std::vector<float>(std::size_t{4} * kHidden * kHidden)};
  for (std::size_t j = 0; j < kHidden; ++j) {
    ih.values[(2 * kHidden + j) * 8 + j] = 1.0f;  // the input reaches the cell by gate g
  }
  network.output(network.lstm(0, ih, hh, {}));
  const formats::MienWriter& done = writer;
  for (const std::uint32_t tier : tiers_here()) {
    OwnedSession engine(finished(done), "net", {}, tier);
    ASSERT_EQ(engine.status, MIEN_OK);
    Map input(1, 1, 8);
    std::fill(input.values.begin(), input.values.end(), 1.0);
    EXPECT_GT(run(*engine.session, input)[0], 0.1f);
    input = Map(1, 1, 8);
    std::vector<float> last;
    for (int step = 0; step < 200; ++step) {
      last = run(*engine.session, input);
      for (const float one : last) {
        EXPECT_TRUE(one == 0.0f || one >= FLT_MIN) << "denormal at step " << step;
      }
    }
    EXPECT_EQ(last, std::vector<float>(8));
  }
}

}  // namespace
}  // namespace mien::tests
