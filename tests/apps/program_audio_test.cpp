// Tests of audio on the command line.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

#include "tests/apps/program.h"
#include "tests/tracker/blob_weights.h"

namespace mien::tests {
namespace {

// The repository's models, with an audio network that responds to loudness only.
class ProgramSound : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    for (const char* name : {"basenet.mien", "proposal.mien"}) {
      if (have_models()) {
        fs::copy(kSource + "/models/" + name, folder_ / name);
      }
    }
  }
  void add_audionet() const {
    const AlignedBytes audionet = blob_audionet();
    std::ofstream file(path("audionet.mien"), std::ios::binary);
    file.write(reinterpret_cast<const char*>(audionet.get().data()),
               static_cast<std::streamsize>(audionet.get().size()));
  }
  std::string models() const { return " --quiet --models " + folder_.string(); }
};

template <class Value>
void put(std::string& bytes, Value value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  bytes.append(raw.begin(), raw.end());
}

// One channel of 16 bits: silence, with a tone in the second quarter.
void write_wav(const std::string& path, int seconds, std::uint32_t rate = 16000) {
  const std::uint32_t frames = static_cast<std::uint32_t>(seconds) * rate;
  std::string bytes = "RIFF";
  put(bytes, 36 + 2 * frames);
  bytes += "WAVEfmt ";
  put(bytes, std::uint32_t{16});
  put(bytes, std::uint16_t{1});
  put(bytes, std::uint16_t{1});
  put(bytes, rate);
  put(bytes, 2 * rate);
  put(bytes, std::uint16_t{2});
  put(bytes, std::uint16_t{16});
  bytes += "data";
  put(bytes, 2 * frames);
  std::uint32_t noise = 1;
  for (std::uint32_t i = 0; i < frames; ++i) {
    noise = noise * 1664525 + 1013904223;
    const bool buzzes = i >= frames / 4 && i < frames / 2;
    put(bytes,
        static_cast<std::int16_t>(buzzes ? static_cast<std::int32_t>(noise >> 17) - 16384 : 0));
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

struct Curve {
  std::vector<double> t_ms, activity;
};

// The columns t_ms and vad.
Curve read_curve(const std::string& csv) {
  Curve curve;
  std::istringstream rows(csv);
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::string cell;
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (column == 1) {
        curve.t_ms.push_back(std::stod(cell));
      } else if (column == 5) {
        curve.activity.push_back(std::stod(cell));
      }
    }
  }
  return curve;
}

void expect_buzz(const Curve& curve, double from_ms, double to_ms) {
  for (std::size_t i = 0; i < curve.t_ms.size(); ++i) {
    const double t = curve.t_ms[i];
    if (t > from_ms + 150 && t < to_ms - 100) {
      EXPECT_GT(curve.activity[i], 0.9) << t;
    } else if (t < from_ms - 100 || t > to_ms + 900) {
      EXPECT_LT(curve.activity[i], 0.1) << t;
    }
  }
}

TEST_F(ProgramSound, AWavGivesThirtyRowsASecond) {
  MIEN_NEEDS("trained model", have_models());
  add_audionet();
  write_wav(path("voice.wav"), 4);
  const Outcome done = run("track " + path("voice.wav") + models(), "PATH=/nowhere");
  ASSERT_EQ(done.code, 0) << done.errors << " (without ffmpeg)";
  const Curve curve = read_curve(done.output);
  ASSERT_NEAR(static_cast<double>(curve.t_ms.size()), 120.0, 1.0);
  EXPECT_NEAR(curve.t_ms[30], 1000.0, 0.01);
  expect_buzz(curve, 1000, 2000);
}

TEST_F(ProgramSound, ReadsAWavFromAPipe) {
  MIEN_NEEDS("trained model", have_models());
  add_audionet();
  write_wav(path("voice.wav"), 2);
  const std::string voice = path("voice.wav");
  const Outcome file = run("track " + voice + models());
  for (const std::string input : {"- --mode audio", "ignored.y4m --audio - --mode audio"}) {
    std::ofstream(path("ignored.y4m")) << "";
    const std::string where = input.starts_with("-") ? input : path(input);
    const Outcome done = run("track " + where + models(), "PATH=/nowhere", voice);
    ASSERT_EQ(done.code, 0) << done.errors;
    EXPECT_EQ(done.output, file.output);
  }
  EXPECT_EQ(run("track - --audio -" + models(), "", voice).code, 2);
  EXPECT_EQ(run("track - --mode audio" + models()).code, 11) << "an empty pipe";
}

TEST_F(ProgramSound, RespectsTheTimeRange) {
  MIEN_NEEDS("trained model", have_models());
  add_audionet();
  write_wav(path("voice.wav"), 4, 44100);
  const Outcome done = run("track " + path("voice.wav") + " --start 0.5 --duration 2.5" + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  const Curve curve = read_curve(done.output);
  ASSERT_NEAR(static_cast<double>(curve.t_ms.size()), 75.0, 1.0);
  EXPECT_NEAR(curve.t_ms.front(), 500.0, 0.01);
  expect_buzz(curve, 1000, 2000);
}

TEST_F(ProgramSound, StaysInSyncWithTheVideo) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  add_audionet();
  write_wav(path("voice.wav"), 4);
  const std::string video = "track " + kClip + " --duration 4 --lod 1 --audio " + path("voice.wav");
  const Outcome done = run(video + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  expect_buzz(read_curve(done.output), 1000, 2000);
  const Outcome later = run(video + " --av-offset-ms 500" + models());
  ASSERT_EQ(later.code, 0) << later.errors;
  expect_buzz(read_curve(later.output), 1500, 2500);
  const Outcome deaf = run(video + " --mode video" + models());
  for (const double activity : read_curve(deaf.output).activity) {
    EXPECT_EQ(activity, 0.0);
  }
}

TEST_F(ProgramSound, UsesTheAudioTrackOfAVideo) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  add_audionet();
  write_wav(path("voice.wav"), 4);
  ASSERT_EQ(std::system(("ffmpeg -v error -t 4 -i " + kClip + " -i " + path("voice.wav") +
                         " -map 0:v -map 1:a -c:v copy -c:a aac " + path("both.mp4"))
                            .c_str()),
            0);
  for (const char* mode : {"", " --mode av", " --mode audio"}) {
    const Outcome done = run("track " + path("both.mp4") + " --lod 1" + mode + models());
    ASSERT_EQ(done.code, 0) << mode << done.errors;
    const Curve curve = read_curve(done.output);
    EXPECT_GT(curve.t_ms.size(), 95u) << mode;
    expect_buzz(curve, 1000, 2000);
  }
}

TEST_F(ProgramSound, WithoutAudioWeightsAVideoIsTrackedAlone) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  EXPECT_EQ(run("track " + kClip + " --duration 0.5" + models()).code, 0);
  EXPECT_EQ(run("track " + kClip + " --mode av" + models()).code, 8);
  EXPECT_EQ(run("track " + kClip + " --mode audio" + models()).code, 8);
}

TEST_F(ProgramSound, MissingAudioIsAnError) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  add_audionet();
  write_wav(path("voice.wav"), 1);
  ASSERT_EQ(
      std::system(("ffmpeg -v error -i " + kClip + " -c copy -an " + path("mute.mp4")).c_str()), 0);
  std::ofstream(path("text.wav")) << "no sound";
  const auto code = [&](const std::string& arguments) {
    const Outcome failed = run("track " + arguments + " -o " + path("out.csv") + models());
    EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
    EXPECT_FALSE(fs::exists(path("out.csv")));
    return failed.code;
  };
  EXPECT_EQ(code(path("mute.mp4") + " --mode av"), 11);
  EXPECT_EQ(code(path("mute.mp4") + " --mode audio"), 11);
  EXPECT_EQ(code(path("text.wav")), 11);
  EXPECT_EQ(code(path("nothing.wav")), 3);
  EXPECT_EQ(code(kClip + " --audio " + path("nothing.wav")), 3);
  EXPECT_EQ(code(kClip + " --audio " + path("nothing.mp3")), 3);
  EXPECT_EQ(code(kClip + " --audio " + path("mute.mp4")), 11);
  EXPECT_EQ(code(path("voice.wav") + " --mode video"), 4);
  EXPECT_EQ(code(path("voice.wav") + " --overlay " + path("o.mp4")), 2);
  EXPECT_EQ(run("track " + path("voice.wav") + " --mode loud").code, 2);
  fs::resize_file(path("voice.wav"), 9000);
  EXPECT_EQ(code(path("voice.wav")), 5);
}

TEST_F(ProgramSound, BenchMeasuresAudio) {
  MIEN_NEEDS("trained model", have_models());
  add_audionet();
  const Outcome done = run("bench --sound --json --models " + folder_.string());
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_NE(done.output.find("\"sample_rate\": 48000"), std::string::npos) << done.output;
}

}  // namespace
}  // namespace mien::tests
