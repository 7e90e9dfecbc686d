// Tests of reading curves: columns are found by name, and errors have a position.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/mien/compare/curves_file.h"
#include "apps/mien/system/failure.h"

namespace mien::tests {
namespace {

using app::Curves;
using app::parse_curves;

constexpr std::size_t kEyeBlinkLeft = 0;
constexpr std::size_t kJawOpen = 17;

std::string complaint(const std::string& text) {
  try {
    parse_curves(text, "x.csv");
  } catch (const app::Failure& failure) {
    EXPECT_EQ(failure.code(), app::kExitNoInput);
    return failure.what();
  }
  return "none";
}

TEST(CurvesFile, ColumnsAreFoundByName) {
  const Curves curves = parse_curves(
      "jawOpen,yaw_rad,unknown,t_ms,pitch_rad,roll_rad\n"
      "0.5,0.1,anything,40,0.2,-0.3\n",
      "x.csv");
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].t_ms, 40.0);
  EXPECT_EQ(curves[0].controls[kJawOpen], 0.5);
  EXPECT_TRUE(std::isnan(curves[0].controls[kEyeBlinkLeft]));
  ASSERT_TRUE(curves[0].head);
  EXPECT_EQ(curves[0].head->pitch, 0.2);
  EXPECT_EQ(curves[0].head->yaw, 0.1);
  EXPECT_EQ(curves[0].head->roll, -0.3);
}

TEST(CurvesFile, EmptyCellsAreUnsupportedControls) {
  const Curves curves = parse_curves(
      "t_ms,pitch_rad,yaw_rad,roll_rad,eyeBlinkLeft,jawOpen\n"
      "0,,,,,0.25\n"
      "33.3,0,0,0,1, \n",
      "x.csv");
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_FALSE(curves[0].head);
  EXPECT_TRUE(std::isnan(curves[0].controls[kEyeBlinkLeft]));
  EXPECT_EQ(curves[0].controls[kJawOpen], 0.25);
  EXPECT_TRUE(curves[1].head);
  EXPECT_EQ(curves[1].controls[kEyeBlinkLeft], 1.0);
  EXPECT_TRUE(std::isnan(curves[1].controls[kJawOpen]));
}

TEST(CurvesFile, ReadsFilesSavedBySpreadsheets) {
  const Curves curves = parse_curves(
      "\xEF\xBB\xBFt_ms,\"jawOpen\",\"a \"\"note\"\", quoted\"\r\n0,\"0.5\",\"x,y\"\r\n\r\n",
      "x.csv");
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].controls[kJawOpen], 0.5);
}

TEST(CurvesFile, SmallFloatsAreNumbers) {
  const Curves curves = parse_curves("t_ms,jawOpen\n0,4.4e-31\n1,1e-45\n", "x.csv");
  EXPECT_EQ(curves[0].controls[kJawOpen], 4.4e-31);
  EXPECT_EQ(curves[1].controls[kJawOpen], 1e-45);
}

TEST(CurvesFile, FaultsHaveAPosition) {
  EXPECT_EQ(complaint(""), "x.csv: line 1, column 1: empty file");
  EXPECT_EQ(complaint("t_ms,jawOpen\n"), "x.csv: line 2, column 1: no frames");
  EXPECT_EQ(complaint("jawOpen\n0\n"), "x.csv: line 1, column 1: t_ms: missing column");
  EXPECT_EQ(complaint("t_ms,frame\n0,0\n"),
            "x.csv: line 1, column 1: no column with a control (eyeBlinkLeft ... "
            "tongueOut), a Roblox unit or a viseme");
  EXPECT_EQ(complaint("t_ms,jawOpen,jawOpen\n0,0,0\n"),
            "x.csv: line 1, column 14: duplicate column 'jawOpen'");
  EXPECT_EQ(complaint("t_ms,jawOpen\n0,0\n1\n"),
            "x.csv: line 3, column 1: wrong number of cells (got 1, expected 2)");
  EXPECT_EQ(complaint("t_ms,jawOpen\n0,\"0\n"),
            "x.csv: line 2, column 3: unterminated quotation mark");
  EXPECT_EQ(complaint("t_ms,jawOpen\n0,0\n,0\n"), "x.csv: line 3, column 1: t_ms: empty");
  EXPECT_EQ(complaint("t_ms,jawOpen\n5,0\n4,0\n"),
            "x.csv: line 3, column 1: t_ms: decreasing time");
  EXPECT_EQ(complaint("t_ms,jawOpen\n0,half\n"),
            "x.csv: line 2, column 3: jawOpen: 'half' is not a number");
  EXPECT_EQ(complaint("t_ms,pitch_rad,yaw_rad,roll_rad,jawOpen\n0,30,0,0,0\n"),
            "x.csv: line 2, column 3: pitch_rad: more than a full turn; angles are in radians");
}

TEST(CurvesFile, ValuesMustBeInRange) {
  for (const char* value : {"nan", "inf", "0x1", "1,5", "1e999", "1.01", "-0.1", "50", "0.5;"}) {
    EXPECT_NE(complaint("t_ms,jawOpen\n0," + std::string(value) + "\n"), "none") << value;
  }
  EXPECT_EQ(complaint("t_ms,jawOpen\n0,50\n"),
            "x.csv: line 2, column 3: jawOpen: '50' is not in 0..1");
}

TEST(CurvesFile, FramesAreLimited) {
  std::string text = "t_ms,jawOpen\n";
  for (int i = 0; i < 216'000; ++i) {
    text += "0,0\n";
  }
  EXPECT_EQ(parse_curves(text, "x.csv").size(), 216'000U);
  EXPECT_EQ(complaint(text + "0,0\n"),
            "x.csv: too many frames to compare (got 216001, expected at most 216000)");
}

TEST(CurvesFile, SurvivesAnyText) {
  const std::string whole =
      "t_ms,\"jawOpen\",pitch_rad,yaw_rad,roll_rad\n0,0.5,0,0,0\n33,0.6,0,0,0\n";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    complaint(whole.substr(0, size));
    for (const char c : {'\0', '"', ',', '\n', '\r', '\xFF', '-'}) {
      std::string changed = whole;
      changed[std::min(size, whole.size() - 1)] = c;
      complaint(changed);
    }
  }
}

// A Live Link Face file has neither its unit nor the rate of its timecode.
TEST(CurvesFile, ReadsUnitsFromTheFileBesideALiveLinkFaceFile) {
  const std::string file = testing::TempDir() + "mien_" + std::to_string(getpid()) + ".csv";
  std::ofstream(file) << "Timecode,BlendshapeCount,JawOpen,HeadYaw,HeadPitch,HeadRoll\n"
                         "00:00:00:00.000,61,0,90,0,0\n00:00:00:12.000,61,0,90,0,0\n";
  std::ofstream(file + ".json") << R"({"rotation":"deg","timecode_fps":24.0})";
  const Curves curves = app::read_curves(file, true);
  std::ofstream(file + ".json") << R"({"rotation":"deg","timecode_fps":0})";
  EXPECT_THROW(app::read_curves(file, true), app::Failure);
  std::filesystem::remove(file + ".json");
  std::filesystem::remove(file);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_NEAR(curves[0].head->yaw, std::acos(0.0), 1e-9);
  EXPECT_NEAR(curves[1].t_ms - curves[0].t_ms, 500.0, 1e-6);
}

TEST(CurvesFile, AMissingFileFails) {
  EXPECT_THROW(app::read_curves("/nowhere/x.csv", true), app::Failure);
  EXPECT_THROW(app::read_curves("/", true), app::Failure);
}

}  // namespace
}  // namespace mien::tests
