// Tests of properties that all animation formats share: readers survive any input, errors have a
// position, times keep their digits, and losses are reported.
#include "apps/animation/animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/animation/rotation.h"
#include "tests/apps/animation/random_clip.h"

namespace mien::animation {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string written(const Clip& clip, AnimationFormat format) {
  const auto writer = animation_writer(format, {});
  std::string text = writer->begin();
  for (const Frame& frame : clip.frames) {
    text += writer->frame(frame);
  }
  return text + writer->finish();
}

TEST(Animation, EndingAndContentDetermineTheFormat) {
  const Clip clip = random_clip(20, 1);
  for (const FormatName& known : kFormatNames) {
    EXPECT_EQ(format_named(known.name), known.format);
    EXPECT_EQ(format_by_ending("a/b" + std::string(known.ending)), known.format) << known.ending;
    const std::string text = written(clip, known.format);
    const AnimationFormat seen = format_by_content(text);
    EXPECT_EQ(seen, known.format) << known.name;
    Clip read;
    Fault fault;
    EXPECT_TRUE(read_animation(seen, text, {}, read, fault)) << known.name << describe(fault);
    EXPECT_FALSE(read.frames.empty());
  }
  EXPECT_EQ(format_by_ending("clip.mp4"), std::nullopt);
  EXPECT_EQ(format_by_ending(".csv"), std::nullopt) << "a hidden file without an ending";
}

std::string read_and_written(const std::string& text, AnimationFormat format) {
  Clip read;
  Fault fault;
  EXPECT_TRUE(read_animation(format, text, {}, read, fault)) << describe(fault);
  return written(read, format);
}

TEST(Animation, AByteOrderMarkIsIgnored) {
  const Clip clip = random_clip(5, 9);
  for (const FormatName& known : kFormatNames) {
    if (known.format == AnimationFormat::kGlb) {
      continue;  // not a text format
    }
    const std::string text = written(clip, known.format);
    const std::string marked = "\xEF\xBB\xBF" + text;
    EXPECT_EQ(format_by_content(marked), known.format) << known.name;
    EXPECT_EQ(read_and_written(marked, known.format), read_and_written(text, known.format))
        << known.name;
  }
}

Clip clip_from(std::int64_t begin_ns) {
  Clip clip = random_clip(20, 10);
  std::vector<Frame> frames = clip.frames.unpacked();
  for (Frame& frame : frames) {
    frame.time_ns += begin_ns;
  }
  clip.frames = FrameSequence(frames);
  return clip;
}

// Nanoseconds since 1970, a camera that started before the audio, and a clip.
TEST(Animation, TimesOfAnyOriginRoundTrip) {
  constexpr std::int64_t kSince1970_ns = 1'700'000'000'033'250'000;
  for (const std::int64_t begin_ns : {kSince1970_ns, std::int64_t{-500'000'000}, std::int64_t{0}}) {
    const Clip clip = clip_from(begin_ns);
    for (const FormatName& known : kFormatNames) {
      SCOPED_TRACE(std::string(known.name) + " from " + std::to_string(begin_ns) + " ns on");
      const std::string text = written(clip, known.format);
      const std::string again = read_and_written(text, known.format);
      const bool over_angles =
          known.format == AnimationFormat::kGltf || known.format == AnimationFormat::kGlb;
      EXPECT_TRUE(over_angles || again == text) << text << again;
    }
  }
}

TEST(Animation, TimesKeepTheirDigits) {
  Clip clip;
  Fault fault;
  ASSERT_TRUE(read_animation(AnimationFormat::kCsv,
                             "t_ms,jawOpen\n1700000000033.25,0\n1700000000066.5,0\n", {}, clip,
                             fault))
      << describe(fault);
  EXPECT_EQ(clip.frames.unpacked()[0].time_ns, 1'700'000'000'033'250'000);
  EXPECT_EQ(clip.frames.unpacked()[0].time_ms(), 1700000000033.25);
  EXPECT_EQ(clip.frames.unpacked()[1].time_ns, 1'700'000'000'066'500'000);
  ASSERT_TRUE(read_animation(AnimationFormat::kRhubarbDat,
                             "MohoSwitch1\n40800000002 A\n40800000003 X\n", {}, clip, fault))
      << describe(fault);
  EXPECT_EQ(clip.frames.unpacked()[0].time_ns, 1'700'000'000'041'666'667);
  EXPECT_EQ(written(clip, AnimationFormat::kRhubarbDat),
            "MohoSwitch1\n40800000002 A\n40800000003 X\n");
}

// Cues count from the start of the audio; a clip that starts earlier is shifted, and a loss is
// reported.
TEST(Animation, CuesBeginAtZero) {
  const Clip clip = clip_from(-500'000'000), moved = clip_from(0);
  for (const AnimationFormat format :
       {AnimationFormat::kRhubarb, AnimationFormat::kRhubarbJson, AnimationFormat::kRhubarbXml,
        AnimationFormat::kRhubarbDat}) {
    EXPECT_EQ(written(clip, format), written(moved, format));
    EXPECT_THAT(losses(clip, format), Contains(HasSubstr("times before 0")));
    EXPECT_THAT(losses(moved, format), Not(Contains(HasSubstr("times before 0"))));
  }
}

// Writers neither overflow nor hang for any allowed times.
TEST(Animation, WritersAcceptTheLargestTimes) {
  constexpr std::int64_t kLast = kLastTime_ns;
  for (const std::vector<std::int64_t>& times :
       std::vector<std::vector<std::int64_t>>{{-kLast, 0, kLast},
                                              {-kLast, 1'000'000'000, kLast},
                                              {-kLast, kLast},
                                              {kLast},
                                              {-kLast},
                                              {kLast, kLast},
                                              {-kLast, -kLast, kLast - 1, kLast}}) {
    Clip clip;
    std::vector<Frame> frames = random_clip(times.size(), 11).frames.unpacked();
    for (std::size_t i = 0; i < times.size(); ++i) {
      frames[i].time_ns = times[i];
    }
    for (const bool has_shapes : {false, true}) {
      for (Frame& frame : frames) {
        frame.mouth_shape = has_shapes ? 'B' : '\0';
      }
      clip.frames = FrameSequence(frames);
      for (const FormatName& known : kFormatNames) {
        SCOPED_TRACE(known.name);
        const std::string text = written(clip, known.format);
        static_cast<void>(losses(clip, known.format));
        // Formats that count from the first frame, or store times of day, reject these.
        if (known.format != AnimationFormat::kGltf && known.format != AnimationFormat::kGlb &&
            known.format != AnimationFormat::kBvh && known.format != AnimationFormat::kLiveLink) {
          read_and_written(text, known.format);
        }
      }
    }
  }
}

// A position in the text: a byte of a line, including its end, or the start of the next line. In a
// binary file or UTF-16: a byte, or a position in its JSON.
void expect_place(const Fault& fault, AnimationFormat format, const std::string& text) {
  SCOPED_TRACE(std::string(name(format)) + ": " + describe(fault));
  if (format == AnimationFormat::kGlb || fault.line == 0) {
    EXPECT_LE(fault.column, text.size() + 1);
    return;
  }
  std::size_t begin = 0, line = 1;
  for (std::size_t end = 0;
       line < fault.line && (end = text.find('\n', begin)) != std::string::npos; ++line) {
    begin = end + 1;
  }
  const bool behind_the_last = fault.line == line + 1 && fault.column == 1;
  EXPECT_TRUE(fault.line == line || behind_the_last);
  EXPECT_GE(fault.column, 1u);
  EXPECT_LE(fault.column, std::min(text.find('\n', begin), text.size()) - begin + 1);
}

// For every format, a file truncated anywhere or with any changed byte is read or rejected with a
// position.
TEST(Animation, ReadersSurviveAnyBytes) {
  const Clip clip = random_clip(3, 2);
  for (const FormatName& known : kFormatNames) {
    const std::string whole = written(clip, known.format);
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 300);
    for (std::size_t size = 0; size < whole.size(); size += step) {
      for (const char c : {'\0', '"', ',', '\n', '9', '-', '{', '\xFF', 'x'}) {
        for (const bool cut : {true, false}) {
          std::string text = cut ? whole.substr(0, size) : whole;
          if (!text.empty()) {
            text[std::min(size, text.size() - 1)] = c;
          }
          Clip read;
          Fault fault;
          if (!read_animation(known.format, text, {}, read, fault)) {
            EXPECT_FALSE(fault.what.empty()) << known.name;
            expect_place(fault, known.format, text);
            EXPECT_TRUE(read.frames.empty()) << "the clip stays unchanged";
          }
        }
      }
    }
  }
}

TEST(Animation, LossesAreReported) {
  Clip clip = random_clip(2, 3);
  EXPECT_THAT(losses(clip, AnimationFormat::kCsv), IsEmpty());
  EXPECT_THAT(losses(clip, AnimationFormat::kGlb), IsEmpty());
  EXPECT_THAT(losses(clip, AnimationFormat::kLiveLink), ElementsAre("head position"));
  EXPECT_THAT(losses(clip, AnimationFormat::kBvh), Contains("the controls"));
  EXPECT_THAT(losses(clip, AnimationFormat::kRoblox), Contains(HasSubstr("jawForward")));
  EXPECT_THAT(losses(clip, AnimationFormat::kRhubarb), Contains("head rotation"));
  std::vector<Frame> frames = clip.frames.unpacked();
  const auto lost = [&frames, &clip](AnimationFormat format) {
    clip.frames = FrameSequence(frames);
    return losses(clip, format);
  };
  frames[0].eyes = gaze(frames[0].controls);
  EXPECT_THAT(lost(AnimationFormat::kCsv), IsEmpty()) << "the controls contain it";
  frames[0].eyes = {Angles{0.3, 0.2, 0.1}, Angles{}};
  EXPECT_THAT(lost(AnimationFormat::kCsv), ElementsAre("eye rotation"));
  frames[1].voice_activity = 0.5;
  EXPECT_THAT(lost(AnimationFormat::kGltf), Contains(HasSubstr("voice activity")));
  EXPECT_THAT(lost(AnimationFormat::kJsonl), IsEmpty());
  frames[1].controls[formats::index_of("eyeLookOutLeft", formats::kArkitNames)] =
      formats::kNoNumber;
  EXPECT_THAT(lost(AnimationFormat::kLiveLink), Contains(HasSubstr("become 0")));
  frames[1].time_ns += 10'000'000'000;
  frames.push_back(frames[1]);
  EXPECT_THAT(lost(AnimationFormat::kBvh), Contains(HasSubstr("become even")));
}

}  // namespace
}  // namespace mien::animation
