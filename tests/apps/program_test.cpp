// Tests of the program: exit codes, one line on stderr, no incomplete files.
#include "tests/apps/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace mien::tests {
namespace {

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

TEST_F(Program, RejectsInputsWithoutVideo) {
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
  const Outcome failed = run("track " + kClip + models(), "PATH=/nowhere");
  EXPECT_EQ(failed.code, 6);
  EXPECT_EQ(failed.errors,
            "mien: cannot run 'ffprobe': not on PATH; install ffmpeg, for example with `apt "
            "install ffmpeg`, `brew install ffmpeg` or `winget install ffmpeg`\n");
}

TEST_F(Program, RejectsUnknownLevelsOfDetail) {
  EXPECT_EQ(run("track " + kClip + " --lod 5").code, 2);
  EXPECT_EQ(run("track " + kClip + " --lod auto --budget-ms 0").code, 2);
}

// Two outputs with the same file, however its name is written, would overwrite each other.
TEST_F(Program, DuplicateOutputsAreRejectedBeforeAnyIsWritten) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  fs::create_directory(path("folder"));
  fs::create_directory_symlink(path("folder"), path("link"));
  const std::string in = "cd " + folder_.string() + " && ";
  const auto refuses = [&](const std::string& outputs) {
    std::ofstream(path("folder/a.csv")) << "before";
    const Outcome failed =
        run("track " + kClip + " --duration 0.2 --lod 1 --quiet " + outputs + models(), in);
    EXPECT_EQ(failed.code, 2) << outputs << ": " << failed.errors;
    EXPECT_NE(failed.errors.find(": duplicate output path"), std::string::npos) << failed.errors;
    EXPECT_EQ(contents(path("folder/a.csv")), "before") << outputs;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name == "a.csv" || name == "folder" || name == "link" || name == "stdout" ||
                  name == "stderr")
          << outputs << ": " << name;
    }
  };
  refuses("-o folder/a.csv -o ./folder/a.csv");
  refuses("-o folder/a.csv --landmarks folder/../folder/a.csv");
  refuses("-o folder/a.csv --landmarks link/a.csv");
  refuses("-o folder/a.csv --stats " + path("folder/a.csv"));
  refuses("-o folder/a.llf.csv --stats folder/a.llf.csv.json");
  refuses("--overlay folder/a.mp4 --landmarks folder/a.mp4");
  refuses("--overlay folder/o.mp4 -o folder/a.csv --report folder/a.csv");
  refuses("--overlay folder/a.html.mp4 --report folder/a.html");
  const Outcome done = run("track " + kClip + " --duration 0.2 --lod 1 --quiet -o /dev/null" +
                               " --landmarks /dev/null --stats folder/s --report folder/r.html" +
                               " --overlay folder/o.mp4" + models(),
                           in);
  EXPECT_EQ(done.code, 0) << done.errors;
}

TEST_F(Program, OutputThatCannotBeWritten) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const Outcome failed = run("track " + kClip + " -o /nowhere/out.csv --quiet" + models());
  EXPECT_EQ(failed.code, 7);
  EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
}

// ffmpeg prints times in seconds, some versions with six digits, so late times would be inexact.
TEST_F(Program, TimestampsOfLongRecordingsAreExact) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  ASSERT_EQ(
      std::system(("ffmpeg -v error -f lavfi -i color=s=64x64:r=3/10000 -frames:v 6 -c:v ffv1 " +
                   path("slow.nut"))
                      .c_str()),
      0);
  const Outcome done = run("track " + path("slow.nut") + " --lod 1" + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_NE(done.output.find("\n1,3333333.333333,"), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("\n5,16666666.666667,"), std::string::npos) << done.output;
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

// An MP4 cut without re-encoding starts with frames that its edit list hides, and may lack frames
// before its last one.
TEST_F(Program, VideosCutWithoutReencodingAreComplete) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const auto cut = [&](const std::string& start, const std::string& duration) {
    EXPECT_EQ(std::system(("ffmpeg -y -v error -ss " + start + " -i " + kClip + " -t " + duration +
                           " -c copy -an -movflags +faststart " + path("cut.mp4"))
                              .c_str()),
              0);
  };
  const auto track = [&] {
    return run("track " + path("cut.mp4") + " --quiet --lod 1 --mode video" + models());
  };
  for (const auto& [start, duration] :
       {std::pair("2", "2"), {"1", "1"}, {"0.1", "1"}, {"3.7", "0.5"}}) {
    cut(start, duration);
    const Outcome done = track();
    EXPECT_EQ(done.code, 0) << start << ": " << done.errors;
    EXPECT_GT(lines(done.output), 15u) << start;
  }
  cut("2", "4");
  fs::resize_file(path("cut.mp4"), fs::file_size(path("cut.mp4")) * 4 / 5);
  EXPECT_EQ(track().code, 5);
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

TEST_F(Program, TheSummaryNamesTimesInUsersWords) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const Outcome done = run("track " + kClip + " --duration 1 -o " + path("out.csv") + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  const std::size_t end = done.errors.find("30 frames, ");
  ASSERT_NE(end, std::string::npos) << done.errors;
  EXPECT_THAT(done.errors.substr(end),
              testing::MatchesRegex("30 frames, .*\n[0-9.]+ ms per frame: detection [0-9.]+, face "
                                    "[0-9.]+, audio [0-9.]+; 95 % within [0-9.]+ ms\n"));
}

TEST_F(Program, TracksSeveralFacesWithIds) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  ASSERT_EQ(std::system(("ffmpeg -v error -t 1 -i " + kClip +
                         " -vf 'split[a][b];[b]hflip[c];[a][c]hstack' -an " + path("two.mp4"))
                            .c_str()),
            0);
  const Outcome done = run("track " + path("two.mp4") + " --max-faces 2 --quiet --landmarks " +
                           path("lm.csv") + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_EQ(done.output.find("frame,face_id,t_ms,status,"), 0u);
  EXPECT_EQ(lines(done.output), 61u) << "two rows for each of 30 frames";
  EXPECT_NE(done.output.find("\n29,1,"), std::string::npos);
  EXPECT_NE(done.output.find("\n29,2,"), std::string::npos);
  EXPECT_EQ(lines(contents(path("lm.csv"))), 61u);
  EXPECT_EQ(run("track " + kClip + " --max-faces 0").code, 2);
  EXPECT_EQ(run("track " + kClip + " --max-faces 9").code, 2);
}

// Of the last row.
double depth(const std::string& json_lines) {
  double x = 0.0, y = 0.0, z = 0.0;
  const std::size_t at = json_lines.rfind("\"position_m\":[");
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(std::sscanf(json_lines.c_str() + at, "\"position_m\":[%lf,%lf,%lf]", &x, &y, &z), 3);
  return -z;
}

// Half of the width has half of the field of view, so the same face is further away.
TEST_F(Program, TheFieldOfViewDeterminesTheDistance) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const auto distance = [&](const std::string& option) {
    const Outcome done =
        run("track " + kClip + " --duration 0.5 --quiet --format jsonl" + option + models());
    EXPECT_EQ(done.code, 0) << done.errors;
    return depth(done.output);
  };
  // The visible face is in front of the head's origin, so the ratio is slightly below that of the
  // tangents.
  const double ratio = distance(" --fov 30") / distance("");
  EXPECT_GT(ratio, 1.8);
  EXPECT_LT(ratio, std::tan(std::acos(-1.0) / 6) / std::tan(std::acos(-1.0) / 12));
  EXPECT_EQ(run("track " + kClip + " --fov 0").code, 2);
  EXPECT_EQ(run("track " + kClip + " --fov 180").code, 2);
}

TEST_F(Program, CapturesAndAppliesNeutralCalibration) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const std::string file = path("me.neutral");
  const Outcome captured = run("neutral " + kClip + " -o " + file + models());
  ASSERT_EQ(captured.code, 0) << captured.errors;
  EXPECT_EQ(fs::file_size(file), 448u);
  const std::string track = "track " + kClip + " --quiet --duration 1" + models();
  const Outcome plain = run(track), calibrated = run(track + " --neutral " + file);
  ASSERT_EQ(calibrated.code, 0) << calibrated.errors;
  EXPECT_EQ(lines(calibrated.output), 31u);
  EXPECT_NE(calibrated.output, plain.output);
  EXPECT_EQ(run(track + " --max-faces 2 --neutral " + file).code, 2);
  EXPECT_EQ(run("neutral " + kClip + " --duration 1 -o " + path("short") + models()).code, 10);
  EXPECT_FALSE(fs::exists(path("short")));
  fs::resize_file(file, 447);
  const Outcome damaged = run(track + " --neutral " + file);
  EXPECT_EQ(damaged.code, 3);
  EXPECT_NE(damaged.errors.find("me.neutral: the neutral file is damaged"), std::string::npos);
  EXPECT_EQ(run(track + " --neutral " + path("nothing")).code, 3);
}

// Standard input cannot be reopened for the second of two captures.
TEST_F(Program, CapturesNeutralCalibrationFromAStream) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  ASSERT_EQ(std::system(("ffmpeg -v error -t 6 -i " + kClip +
                         " -pix_fmt yuv420p -vf scale=320:-2 " + path("clip.y4m"))
                            .c_str()),
            0);
  const Outcome streamed =
      run("neutral - -o " + path("me.neutral") + models(), "", path("clip.y4m"));
  EXPECT_EQ(streamed.code, 0) << streamed.errors;
  EXPECT_EQ(fs::file_size(path("me.neutral")), 448u);
  const Outcome tracked =
      run("track " + path("clip.y4m") + " --quiet --neutral " + path("me.neutral") + models());
  EXPECT_EQ(tracked.code, 0) << tracked.errors;
  // A file, which is read twice, may be half as long.
  EXPECT_EQ(run("neutral " + path("clip.y4m") + " --duration 2.5 -o " + path("b") + models()).code,
            0);
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

TEST_F(Program, BenchComparesNetworksWithThePeak) {
  MIEN_NEEDS("trained model", have_models());
  const Outcome done = run("bench --model basenet_pose_decoder --tier ref --json" + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  for (const char* key : {"peak_gflops", "\"name\": \"basenet_pose_decoder\"", "\"tier\": \"ref\"",
                          "macs", "min_ms", "median_ms", "p95_ms", "gflops", "peak_fraction"}) {
    EXPECT_NE(done.output.find(key), std::string::npos) << key << "\n" << done.output;
  }
  EXPECT_EQ(run("bench --model nobody" + models()).code, 2);
}

TEST_F(Program, BenchOfAClipComparesTrackingWithDetection) {
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

TEST_F(Program, BenchOfLevelsMeasuresEachStage) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const Outcome done = run("bench --json --rounds 2 --levels " + kClip + models());
  ASSERT_EQ(done.code, 0) << done.errors;
  for (const char* key : {"start_ms", "highest_of_networks", "\"lod\": 4", "mean_us", "warp"}) {
    EXPECT_NE(done.output.find(key), std::string::npos) << key << "\n" << done.output;
  }
  EXPECT_EQ(run("bench --levels " + path("nowhere.mp4") + models()).code, 3);
}

TEST_F(Program, CompareWritesACompletePage) {
  std::ofstream(path("a.csv")) << "t_ms,jawOpen\n0,0\n40,0.5\n80,0.5\n";
  std::ofstream(path("b.csv")) << "t_ms,jawOpen,more\n1,0.25,x\n41,0.25,y\n";
  const std::string files = "compare " + path("a.csv") + " " + path("b.csv") + " -o ";
  const Outcome done = run(files + path("page.html"), "PATH=/nowhere");
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_NE(done.output.find("2 frames matched by time, 1 controls in both"), std::string::npos)
      << done.output;
  EXPECT_NE(done.output.find("jawOpen                 0.2500"), std::string::npos) << done.output;
  const std::string page = contents(path("page.html"));
  EXPECT_EQ(page.find("<!DOCTYPE html>"), 0u);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
  EXPECT_EQ(run(files + path("page.html") + " --quiet").output, "");
}

TEST_F(Program, CompareFailsWithOneLineAndWithoutAPage) {
  std::ofstream(path("a.csv")) << "t_ms,jawOpen\n0,0\n40,0.5\n";
  std::ofstream(path("bad.csv")) << "t_ms,jawOpen\n0,0\n40,lots\n";
  std::ofstream(path("late.csv")) << "t_ms,jawOpen\n5000,0\n5040,0\n";
  const auto compare = [&](const std::string& a, const std::string& b, const std::string& more) {
    return run("compare " + path(a) + " " + path(b) + " " + more);
  };
  const std::string page = "-o " + path("page.html");
  EXPECT_EQ(compare("a.csv", "a.csv", "").code, 2);
  const Outcome bad = compare("a.csv", "bad.csv", page);
  EXPECT_EQ(bad.code, 3);
  EXPECT_EQ(bad.errors,
            "mien: " + path("bad.csv") + ": line 3, column 4: jawOpen: 'lots' is not a number\n");
  EXPECT_EQ(compare("nothing.csv", "a.csv", page).code, 3);
  EXPECT_EQ(compare("a.csv", "late.csv", page).code, 3);
  EXPECT_EQ(compare("a.csv", "a.csv", "-o /nowhere/page.html").code, 7);
  EXPECT_EQ(run("compare " + path("a.csv") + " " + path("a.csv") + " --video " + kClip + " " + page,
                "PATH=/nowhere")
                .code,
            6);
  EXPECT_EQ(compare("a.csv", "a.csv", "--video " + path("nothing.mp4") + " " + page).code,
            have_ffmpeg() ? 3 : 6);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename().string().find("page"), std::string::npos) << entry.path();
  }
}

TEST_F(Program, CompareRejectsInvalidAndTruncatedVideos) {
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  std::ofstream(path("a.csv")) << "t_ms,jawOpen\n0,0\n7900,0.5\n";
  ASSERT_EQ(std::system(("ffmpeg -v error -i " + kClip + " -c copy -an -movflags +faststart " +
                         path("half.mp4"))
                            .c_str()),
            0);
  fs::resize_file(path("half.mp4"), fs::file_size(path("half.mp4")) / 2);
  const std::string begin = "compare " + path("a.csv") + " " + path("a.csv") + " --video ";
  const std::string page = " -o " + path("page.html");
  EXPECT_EQ(run(begin + path("a.csv") + page).code, 4);
  const Outcome truncated = run(begin + path("half.mp4") + page);
  EXPECT_EQ(truncated.code, 5);
  EXPECT_EQ(lines(truncated.errors), 1u) << truncated.errors;
  EXPECT_FALSE(fs::exists(path("page.html")));
}

}  // namespace
}  // namespace mien::tests
