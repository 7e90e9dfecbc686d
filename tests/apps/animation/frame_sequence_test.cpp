// Tests of the compressed frame sequence.
#include "apps/animation/frame_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "apps/animation/facs_map.h"
#include "formats/vocabulary/visemes.h"

namespace mien::animation {
namespace {

class RandomFrames {
 public:
  explicit RandomFrames(unsigned seed) : random_(seed) {}

  Frame next() {
    Frame frame;
    frame.number = integer();
    frame.time_ns = integer();
    frame.face_id = integer();
    frame.lod = integer();
    frame.state = static_cast<FaceState>(below(3));
    frame.step = below(2) == 0;
    frame.face_probability = value();
    frame.voice_activity = value();
    for (double& control : frame.controls) {
      control = value();
    }
    if (below(2) == 0) {
      frame.box = {value(), value(), value(), value()};
      frame.head = turn();
    }
    if (below(2) == 0) {
      frame.position_m = {value(), value(), value()};
      frame.eyes = {turn(), turn()};
    }
    made(frame);
    return frame;
  }

 private:
  std::uint64_t below(std::uint64_t end) { return random_() % end; }
  std::int64_t integer() {
    constexpr std::int64_t kEnds[] = {0, 1, -1, std::numeric_limits<std::int64_t>::min(),
                                      std::numeric_limits<std::int64_t>::max()};
    return below(3) == 0 ? kEnds[below(5)] : std::bit_cast<std::int64_t>(random_());
  }
  // Also values with nine decimals, values close to these, and arbitrary bits: signed zeros, NaNs.
  double value() {
    switch (below(6)) {
      case 0:
        return formats::kNoNumber;
      case 1:
        return -0.0;
      case 2:
        return std::bit_cast<double>(random_());
      case 3:
        return static_cast<double>(below(4'000'000'000)) / 1e9 - 2.0;
      case 4:
        return 2.147 + static_cast<double>(below(3)) * 1e-9;
      default:
        return static_cast<double>(below(100)) / 100.0;
    }
  }
  Angles turn() { return {value(), value(), value()}; }

  // Values of a vocabulary: controls derived from it, and others.
  void made(Frame& frame) {
    const std::uint64_t kind = below(5);
    if (kind == 0) {
      frame.mouth_shape = formats::kMouthShapes[below(formats::kMouthShapes.size())];
      frame.controls =
          formats::controls_of_visemes(formats::visemes_of_mouth_shape(frame.mouth_shape));
    } else if (kind == 1) {
      frame.facs.assign(formats::kFacsCount, 0.25);
      frame.facs[below(formats::kFacsCount)] = value();
      frame.controls = controls_of_facs(std::span<const double, formats::kFacsCount>(frame.facs));
    } else if (kind == 2) {
      frame.visemes.assign(formats::kVisemeCount, 0.125);
      frame.controls = formats::controls_of_visemes(
          std::span<const double, formats::kVisemeCount>(frame.visemes));
    }
    if (below(8) == 0) {
      frame.controls[below(formats::kControlCount)] = 0.75;
    }
  }

  std::mt19937_64 random_;
};

std::vector<std::uint64_t> bits(const Frame& frame) {
  std::vector<double> values(frame.controls.begin(), frame.controls.end());
  values.insert(values.end(), {frame.face_probability, frame.voice_activity});
  const auto add = [&values](const Angles& angles) {
    values.insert(values.end(), {angles.pitch, angles.yaw, angles.roll});
  };
  if (frame.box) {
    values.insert(values.end(), frame.box->begin(), frame.box->end());
  }
  if (frame.head) {
    add(*frame.head);
  }
  if (frame.position_m) {
    values.insert(values.end(), frame.position_m->begin(), frame.position_m->end());
  }
  if (frame.eyes) {
    add((*frame.eyes)[0]);
    add((*frame.eyes)[1]);
  }
  values.insert(values.end(), frame.facs.begin(), frame.facs.end());
  values.insert(values.end(), frame.visemes.begin(), frame.visemes.end());
  std::vector<std::uint64_t> bits = {std::bit_cast<std::uint64_t>(frame.number),
                                     std::bit_cast<std::uint64_t>(frame.time_ns),
                                     std::bit_cast<std::uint64_t>(frame.face_id),
                                     std::bit_cast<std::uint64_t>(frame.lod),
                                     static_cast<std::uint64_t>(frame.state),
                                     static_cast<std::uint64_t>(frame.mouth_shape),
                                     std::uint64_t{frame.step},
                                     std::uint64_t{frame.box.has_value()},
                                     std::uint64_t{frame.head.has_value()},
                                     std::uint64_t{frame.position_m.has_value()},
                                     std::uint64_t{frame.eyes.has_value()},
                                     frame.facs.size(),
                                     frame.visemes.size()};
  for (const double value : values) {
    bits.push_back(std::bit_cast<std::uint64_t>(value));
  }
  return bits;
}

TEST(FrameSequence, RestoresEveryBit) {
  RandomFrames random(1);
  std::vector<Frame> frames;
  FrameSequence sequence;
  for (int i = 0; i < 3000; ++i) {
    frames.push_back(random.next());
    sequence.push_back(frames.back());
  }
  ASSERT_EQ(sequence.size(), frames.size());
  EXPECT_EQ(sequence.first_time_ns(), frames.front().time_ns);
  EXPECT_EQ(sequence.last_time_ns(), frames.back().time_ns);
  for (std::size_t i = 0; const Frame& frame : sequence) {
    ASSERT_EQ(bits(frame), bits(frames[i++]));
  }
  std::size_t i = 0;
  sequence.consume([&](const Frame& frame) { ASSERT_EQ(bits(frame), bits(frames[i++])); });
  EXPECT_EQ(i, frames.size());
  EXPECT_TRUE(sequence.empty());
  EXPECT_EQ(sequence.begin(), FrameSequence::end());
}

TEST(FrameSequence, SparseFramesTakeLittleMemory) {
  FrameSequence sequence;
  Frame frame;
  for (int i = 0; i < 1000; ++i) {
    frame.number = i;
    frame.time_ns = 40 * kMillisecond_ns * i;
    frame.controls[formats::control("jawOpen")] = i % 2;
    sequence.push_back(frame);
  }
  EXPECT_LE(sequence.bytes(), 16'000u) << "Frames take 700,000";
}

TEST(FrameSequence, RespectsItsLimit) {
  RandomFrames random(2);
  FrameSequence sequence;
  sequence.limit_bytes(50'000);
  std::size_t added = 0;
  while (sequence.add(random.next())) {
    ++added;
  }
  EXPECT_GT(added, 50u);
  EXPECT_EQ(sequence.size(), added);
  EXPECT_LE(sequence.bytes(), 50'000u);
  EXPECT_EQ(sequence.unpacked().size(), added) << "existing frames remain";
}

}  // namespace
}  // namespace mien::animation
