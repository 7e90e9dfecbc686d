// The program as its users meet it: exit codes, one line on stderr, no half-written file.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace mien::tests {
namespace {

namespace fs = std::filesystem;

const std::string kSource = MIEN_SOURCE_DIR;
const std::string kClip = kSource + "/tests/data/demo.mp4";

struct Outcome {
  int code;
  std::string output, errors;
};

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() /
        ("mien_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome run(const std::string& arguments, const std::string& environment = "") const {
    const std::string out = path("stdout"), err = path("stderr");
    const std::string command = environment + " '" + MIEN_PROGRAM + "' " + arguments + " >" + out +
                                " 2>" + err + " </dev/null";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), contents(out), contents(err)};
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string models() const { return " --models " + kSource + "/models"; }

  static bool have_ffmpeg() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }
  static bool have_models() { return fs::exists(kSource + "/models/basenet.mien"); }

  fs::path folder_;
};

#define MIEN_NEEDS(what, condition) \
  if (!(condition)) GTEST_SKIP() << "skipped: no " what " here"

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(Program, WrongUsage) {
  EXPECT_EQ(run("").code, 2);
  EXPECT_EQ(run("dance").code, 2);
  EXPECT_EQ(run("track").code, 2);
  EXPECT_EQ(run("track x.mp4 --start -1").code, 2);
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_EQ(run("--version").code, 0);
}

TEST_F(Program, MissingModels) {
  const Outcome failed = run("track " + kClip + " --models " + path("nowhere"));
  EXPECT_EQ(failed.code, 8);
  EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
}

TEST_F(Program, DamagedModel) {
  std::ofstream(path("bad.mien")) << "not a weight file";
  const Outcome failed = run("inspect " + path("bad.mien"));
  EXPECT_EQ(failed.code, 8);
  EXPECT_NE(failed.errors.find("bad.mien"), std::string::npos);
}

TEST_F(Program, InputsThatAreNoVideo) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  EXPECT_EQ(run("track " + path("nothing.mp4") + models()).code, 3);
  EXPECT_EQ(run("track " + folder_.string() + models()).code, 3);
  std::ofstream(path("text.mp4")) << "no video";
  const Outcome failed = run("track " + path("text.mp4") + " -o " + path("out.csv") + models());
  EXPECT_EQ(failed.code, 4);
  EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
  EXPECT_FALSE(fs::exists(path("out.csv")));
}

TEST_F(Program, FfmpegMissing) {
  MIEN_NEEDS("trained model", have_models());
  EXPECT_EQ(run("track " + kClip + models(), "PATH=/nowhere").code, 6);
}

TEST_F(Program, LevelsOfDetailThatAreNone) {
  EXPECT_EQ(run("track " + kClip + " --lod 5").code, 2);
  EXPECT_EQ(run("track " + kClip + " --lod auto --budget-ms 0").code, 2);
}

TEST_F(Program, OutputThatCannotBeWritten) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const Outcome failed = run("track " + kClip + " -o /nowhere/out.csv --quiet" + models());
  EXPECT_EQ(failed.code, 7);
  EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
}

TEST_F(Program, TruncatedVideoLeavesNoOutput) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  ASSERT_EQ(std::system(("ffmpeg -v error -i " + kClip + " -c copy -an -movflags +faststart " +
                         path("whole.mp4"))
                            .c_str()),
            0);
  fs::resize_file(path("whole.mp4"), fs::file_size(path("whole.mp4")) / 2);
  const Outcome failed =
      run("track " + path("whole.mp4") + " --quiet -o " + path("out.csv") + models());
  EXPECT_EQ(failed.code, 5) << failed.errors;
  EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
  EXPECT_FALSE(fs::exists(path("out.csv")));
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename().string().find(".partial"), std::string::npos) << entry.path();
  }
}

TEST_F(Program, TracksTheDemoClip) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const Outcome done =
      run("track " + kClip + " --quiet --duration 2 -o " + path("out.csv") + " --landmarks " +
          path("lm.csv") + " --stats " + path("stats.json") + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_EQ(done.errors, "");
  const std::string curves = contents(path("out.csv"));
  EXPECT_EQ(lines(curves), 61u);
  const std::string header = curves.substr(0, curves.find('\n'));
  EXPECT_EQ(header.find("frame,t_ms,status,face_prob,lod,vad,x,y,w,h,pitch_rad,yaw_rad,roll_rad,tx_"
                        "m,ty_m,tz_m,eyeBlinkLeft,"),
            0u);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), 15 + 52);
  EXPECT_EQ(lines(contents(path("lm.csv"))), 61u);
  EXPECT_NE(contents(path("stats.json")).find("\"frames\": 60"), std::string::npos);
  EXPECT_NE(contents(path("stats.json")).find("\"tracker_bytes\": "), std::string::npos);
  EXPECT_NE(contents(path("stats.json")).find("\"total_ms\": "), std::string::npos);
}

TEST_F(Program, Y4mNeedsNoFfmpegAndGivesTheSameFrames) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  ASSERT_EQ(
      std::system(
          ("ffmpeg -v error -t 1 -i " + kClip + " -pix_fmt yuv420p " + path("clip.y4m")).c_str()),
      0);
  const Outcome done = run("track " + path("clip.y4m") + " --quiet" + models(), "PATH=/nowhere");
  EXPECT_EQ(done.code, 0) << done.errors;
  EXPECT_EQ(lines(done.output), 31u);
  EXPECT_NE(done.output.find("tracking"), std::string::npos);
}

TEST_F(Program, BenchTimesNetworksAgainstThePeak) {
  MIEN_NEEDS("trained model", have_models());
  const Outcome done = run("bench --model basenet_pose_decoder --tier ref --json" + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  for (const char* key : {"peak_gflops", "\"name\": \"basenet_pose_decoder\"", "\"tier\": \"ref\"",
                          "macs", "min_ms", "median_ms", "p95_ms", "gflops", "peak_fraction"}) {
    EXPECT_NE(done.output.find(key), std::string::npos) << key << "\n" << done.output;
  }
  EXPECT_EQ(run("bench --model nobody" + models()).code, 2);
}

TEST_F(Program, BenchOfAClipFollowsTheFaceAndProposesAnew) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  ASSERT_EQ(
      std::system(
          ("ffmpeg -v error -t 1 -i " + kClip + " -pix_fmt yuv420p " + path("clip.y4m")).c_str()),
      0);
  const Outcome done = run("bench --json --clip " + path("clip.y4m") + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  for (const char* key : {"\"frames\": 30", "\"proposal_runs\": 1,", "\"followed\"",
                          "\"proposed_on_every_frame\"", "\"speedup\""}) {
    EXPECT_NE(done.output.find(key), std::string::npos) << key << "\n" << done.output;
  }
  EXPECT_EQ(run("bench --clip " + path("nowhere.y4m") + models()).code, 3);
}

}  // namespace
}  // namespace mien::tests
