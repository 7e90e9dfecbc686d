// Tests of frames that are filled by tracking backward, with the demo clip and gray frames in it.
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/program.h"

namespace mien::tests {
namespace {

using Cells = std::vector<std::string>;

std::vector<Cells> rows_of(const std::string& csv) {
  std::vector<Cells> rows;
  std::istringstream text(csv);
  for (std::string line; std::getline(text, line);) {
    Cells& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      row.push_back(cell);
    }
  }
  rows.erase(rows.begin());
  return rows;
}

constexpr std::size_t kStatus = 2, kX = 6, kWidth = 8;

std::size_t tracked(const std::vector<Cells>& rows) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [](const Cells& row) { return row[kStatus] == "tracking"; }));
}

class ProgramBackward : public Program {
 protected:
  // Frames of the demo clip, gray where the expression of ffmpeg's `n` holds.
  [[nodiscard]] std::string clip(const std::string& gray, int frames) const {
    std::string made = path("clip.y4m");
    const std::string filter = "scale=320:-2,drawbox=enable='" + gray + "':color=gray:t=fill";
    EXPECT_EQ(std::system(("ffmpeg -v error -y -i " + kClip + " -an -vf \"" + filter +
                           "\" -frames:v " + std::to_string(frames) + " " + made)
                              .c_str()),
              0);
    return made;
  }
  [[nodiscard]] std::vector<Cells> track(const std::string& input, const std::string& more) const {
    const Outcome done = run("track " + input + " --mode video --quiet " + more + models());
    EXPECT_EQ(done.code, 0) << done.errors;
    return rows_of(done.output);
  }
};

TEST_F(ProgramBackward, AFaceIsTrackedFromTheFrameOnWhichItAppears) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const std::string whole = clip("0", 40);
  const std::vector<Cells> truth = track(whole, "--lod 1");
  // 13: detection is at another roll when the face appears, so without tracking backwards it is
  // late.
  const std::string input = clip("lt(n,13)", 40);
  for (const char* lod : {"--lod 1", "--lod 4"}) {
    const std::vector<Cells> forward = track(input, std::string("--no-backward ") + lod);
    const std::vector<Cells> rows = track(input, lod);
    ASSERT_EQ(rows.size(), 40u);
    EXPECT_EQ(rows[12][kStatus], "searching");
    EXPECT_LT(tracked(forward), tracked(rows));
    for (std::size_t i = 14; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i][kStatus], "tracking") << i;
      const double width = std::stod(truth[i][kWidth]);
      EXPECT_NEAR(std::stod(rows[i][kX]), std::stod(truth[i][kX]), 0.05 * width) << i;
      EXPECT_NEAR(std::stod(rows[i][kWidth]), width, 0.08 * width) << i;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (forward[i][kStatus] == "tracking") {
        EXPECT_EQ(rows[i], forward[i]) << "rows with a face do not change";
      }
    }
    EXPECT_EQ(track(input, lod), rows) << "the same each time";
  }
}

TEST_F(ProgramBackward, AGapIsFilledUpToTheOcclusion) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const std::string input = clip("between(n,30,49)", 80);
  const std::vector<Cells> rows = track(input, "--lod 1");
  EXPECT_LT(tracked(track(input, "--lod 1 --no-backward")), tracked(rows));
  for (std::size_t i = 40; i < 50; ++i) {
    EXPECT_EQ(rows[i][kStatus], "lost") << i;
  }
  for (std::size_t i = 51; i < 80; ++i) {
    EXPECT_EQ(rows[i][kStatus], "tracking") << i;
  }
}

TEST_F(ProgramBackward, AClipWithoutAFaceStaysEmpty) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const std::string input = clip("1", 120);  // longer than frames wait
  const std::vector<Cells> rows = track(input, "--lod 1");
  EXPECT_EQ(rows.size(), 120u);
  EXPECT_EQ(tracked(rows), 0u);
  EXPECT_EQ(rows, track(input, "--lod 1 --no-backward"));
}

TEST_F(ProgramBackward, OneOfSeveralFacesIsFilledUnderItsId) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  // Two of the clip side by side; the right one appears later.
  const std::string input = path("two.y4m");
  ASSERT_EQ(std::system(("ffmpeg -v error -y -i " + kClip +
                         " -an -filter_complex \"[0:v]scale=240:-2,split[a][b];[b]drawbox=enable="
                         "'lt(n,20)':color=gray:t=fill[c];[a][c]hstack\" -frames:v 90 " +
                         input)
                            .c_str()),
            0);
  const auto second = [&](const std::string& more) {
    std::vector<std::int64_t> frames;
    for (const Cells& row : track(input, "--lod 1 --max-faces 2 " + more)) {
      if (row[1] == "2" && row[kStatus + 1] == "tracking") {
        frames.push_back(std::stoll(row[0]));
      }
    }
    return frames;
  };
  const std::vector<std::int64_t> forward = second("--no-backward"), both = second("");
  ASSERT_FALSE(forward.empty());
  ASSERT_LT(both.size(), 90u);
  EXPECT_GT(forward.front(), 21);
  EXPECT_GE(both.front(), 20);
  EXPECT_LE(both.front(), 21);
  for (std::size_t i = 1; i < both.size(); ++i) {
    EXPECT_EQ(both[i], both[i - 1] + 1);
  }
}

TEST_F(ProgramBackward, StatisticsCountFilledFrames) {
  MIEN_NEEDS("trained model", have_models());
  MIEN_NEEDS("ffmpeg", have_ffmpeg());
  const std::vector<Cells> rows =
      track(clip("lt(n,10)", 40), "--lod 1 --overlay " + path("o.mp4") + " --report " +
                                      path("r.html") + " -o - --stats " + path("s.json"));
  const std::string stats = contents(path("s.json"));
  EXPECT_NE(stats.find("\"frames_with_face\": " + std::to_string(tracked(rows))), std::string::npos)
      << stats;
  EXPECT_EQ(stats.find("\"frames_filled_backward\": 0,"), std::string::npos) << stats;
  EXPECT_GT(fs::file_size(path("o.mp4")), 1000u);
  EXPECT_GT(fs::file_size(path("r.html")), 1000u);
}

}  // namespace
}  // namespace mien::tests
