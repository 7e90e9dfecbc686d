// Measures the use of the stack against the limits of include/mien/mien.h.
#include "tests/engine/painted_stack.h"

#include <gtest/gtest.h>
#include <mien/mien.hpp>

#include <vector>

#include "tests/engine/mini_model.h"
#include "tests/tracker/blob_tracker.h"

namespace mien::tests {
namespace {

TEST(Stack, StaysWithinTheDocumentedLimits) {
  const AlignedBytes basenet = blob_basenet();
  const AlignedBytes proposal = blob_proposal();
  const AlignedBytes hifinet = blob_hifinet();
  const AlignedBytes audionet = blob_audionet();
  const BlobConfig config = blob_config(basenet, proposal, hifinet, audionet);
  Tracker tracker;
  mien_status status = MIEN_ERROR_OUT_OF_MEMORY;
  const std::size_t create = stack_of([&] { status = tracker.create(config); });
  ASSERT_EQ(status, MIEN_OK);
  EXPECT_LT(create, 96u * 1024);
  EXPECT_GT(create, 30u * 1024) << "nothing was measured";

  const Buffer frame(disc_picture(150, 110, 80), {});
  Result result;
  const auto push = [&](std::int64_t pts_ns) {
    return stack_of([&] { status = tracker.push_video(frame.image(), pts_ns); });
  };
  for (std::int64_t i = 0; i < 3; ++i) {  // the first runs detection, the others track
    EXPECT_LT(push(i * kFrameNs), 16u * 1024) << i;
    ASSERT_EQ(status, MIEN_OK);
  }
  const std::vector<float> samples(4800, 0.1f);
  Audio audio;
  audio.frames = samples.size();
  audio.samples[0] = samples.data();
  EXPECT_LT(stack_of([&] { status = tracker.push_audio(audio, 0); }), 16u * 1024);
  EXPECT_EQ(status, MIEN_OK);
  EXPECT_LT(stack_of([&] { status = tracker.advance(3 * kFrameNs); }), 16u * 1024);
  EXPECT_EQ(status, MIEN_OK);
  EXPECT_LT(stack_of([&] { status = tracker.get_result(result); }), 16u * 1024);
  EXPECT_EQ(status, MIEN_OK);
  EXPECT_LT(stack_of([&] { status = tracker.reset(); }), 16u * 1024);
  EXPECT_TRUE(result.has_face());
}

TEST(Stack, SufficesToUnpackWeights) {
  AlignedBuffer packed = read_file(MIEN_SOURCE_DIR "/tests/golden/packed/accept/small.packed");
  const std::span<const std::byte> file = packed.span();
  Weights weights;
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t used = stack_of([&] { status = weights.create({&file, 1}); });
  EXPECT_EQ(status, MIEN_OK);
  EXPECT_LT(used, 96u * 1024);
  EXPECT_GT(used, 8u * 1024) << "nothing was measured";
}

}  // namespace
}  // namespace mien::tests
