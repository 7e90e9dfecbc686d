// Tests of folders: every file is processed once, and a stopped run continues.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "tests/apps/program.h"

namespace mien::tests {
namespace {

class ProgramBatch : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    fs::create_directories(path("in/below"));
    for (const char* name : {"in/a.mp4", "in/below/b.MP4"}) {
      fs::copy_file(kClip, path(name));
    }
    std::ofstream(path("in/notes.txt")) << "no recording";
  }
  Outcome track(const std::string& more) const {
    return run("track " + path("in") + " --out " + path("out") + " --duration 1 " + more +
               models());
  }
};

TEST_F(ProgramBatch, ProcessesEveryFileOnce) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const Outcome first = track("--jobs 2 --format csv --format glb");
  EXPECT_EQ(first.code, 0) << first.errors;
  for (const char* made :
       {"out/a.mp4.csv", "out/a.mp4.glb", "out/below/b.MP4.csv", "out/below/b.MP4.glb"}) {
    EXPECT_TRUE(fs::exists(path(made))) << made;
  }
  EXPECT_EQ(run("track " + kClip + " --duration 1 --quiet" + models()).output,
            contents(path("out/a.mp4.csv")))
      << "the same as by itself";
  const auto written = fs::last_write_time(path("out/a.mp4.csv"));

  // As if killed: one output is missing, another one is incomplete.
  fs::remove(path("out/below/b.MP4.glb"));
  const Outcome second = track("--format csv --format glb");
  EXPECT_EQ(second.code, 0) << second.errors;
  EXPECT_NE(second.output.find("a.mp4        done before"), std::string::npos) << second.output;
  EXPECT_NE(second.output.find("below/b.MP4  done  "), std::string::npos) << second.output;
  EXPECT_EQ(fs::last_write_time(path("out/a.mp4.csv")), written);
  EXPECT_TRUE(fs::exists(path("out/below/b.MP4.glb")));

  // A newer recording is processed again.
  fs::last_write_time(path("in/a.mp4"), written + std::chrono::seconds(5));
  const Outcome third = track("");
  EXPECT_NE(third.output.find("a.mp4        done  "), std::string::npos) << third.output;
}

TEST_F(ProgramBatch, AFailureIsReportedAndStopsNothing) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  std::ofstream(path("in/0.mp4")) << "no video";
  const Outcome outcome = track("--json --jobs 1");
  EXPECT_EQ(outcome.code, 12);
  EXPECT_NE(outcome.errors.find("1 of 3 files failed:\n"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("in/0.mp4: "), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.output.find("\"outcome\": \"failed\""), std::string::npos) << outcome.output;
  EXPECT_TRUE(fs::exists(path("out/below/b.MP4.csv")));
  EXPECT_FALSE(fs::exists(path("out/0.mp4.csv")));
}

// The target of a link is elsewhere, but its outputs belong to the link's name.
TEST_F(ProgramBatch, LinksAreRecordingsWithTheirOwnNames) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  fs::create_directory(path("archive"));
  fs::rename(path("in/a.mp4"), path("archive/x.mp4"));
  fs::create_symlink("../archive/x.mp4", path("in/a.mp4"));
  const Outcome outcome = track("--jobs 1");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("\na.mp4 "), std::string::npos) << outcome.output;
  EXPECT_TRUE(fs::exists(path("out/a.mp4.csv")));
  EXPECT_FALSE(fs::exists(path("archive/x.mp4.csv")));
}

TEST_F(ProgramBatch, WrongUsage) {
  EXPECT_EQ(run("track " + path("in")).code, 3);
  EXPECT_EQ(track("-o x.csv").code, 2);
  EXPECT_EQ(track("--format nothing").code, 2);
  EXPECT_EQ(run("track " + kClip + " --jobs 2").code, 2);
  fs::create_directories(path("empty"));
  EXPECT_EQ(run("track " + path("empty") + " --out " + path("out")).code, 3);
}

}  // namespace
}  // namespace mien::tests
