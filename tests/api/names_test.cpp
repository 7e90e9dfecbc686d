// Tests of names, counts, versions and status messages.
#include <gtest/gtest.h>
#include <mien/mien.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "kernels/tier.h"

namespace mien::tests {
namespace {

TEST(Names, EveryStatusHasItsOwnMessage) {
  std::ifstream header(MIEN_SOURCE_DIR "/include/mien/mien.h");
  std::stringstream text;
  text << header.rdbuf();
  std::set<int> numbers;
  std::set<std::string> messages;
  std::string line;
  while (std::getline(text, line)) {
    const std::size_t name = line.find("MIEN_ERROR_");
    const std::size_t equals = line.find(" = -");
    if (name == std::string::npos || equals == std::string::npos) {
      continue;
    }
    const int number = std::stoi(line.substr(equals + 3));
    EXPECT_TRUE(numbers.insert(number).second) << line;
    const std::string message = mien_status_string(static_cast<mien_status>(number));
    EXPECT_NE(message, "unknown status") << line;
    EXPECT_TRUE(messages.insert(message).second) << line;
  }
  EXPECT_GE(numbers.size(), 20u);
  EXPECT_STREQ(mien_status_string(MIEN_OK), "ok");
  EXPECT_STREQ(mien_status_string(static_cast<mien_status>(-19)), "unknown status");
  EXPECT_STREQ(mien_status_string(static_cast<mien_status>(1)), "unknown status");
}

TEST(Names, Controls) {
  ASSERT_EQ(mien_control_count(), 52);
  EXPECT_EQ(control_name(0), "eyeBlinkLeft");
  EXPECT_EQ(control_name(17), "jawOpen");
  EXPECT_EQ(control_name(51), "tongueOut");
  EXPECT_EQ(mien_control_name(-1), nullptr);
  EXPECT_EQ(mien_control_name(52), nullptr);
  std::set<std::string_view> names;
  for (int i = 0; i < 52; ++i) {
    EXPECT_TRUE(names.insert(control_name(i)).second);
  }
  for (std::string_view name : names) {  // each left control has a right one
    if (name.ends_with("Left")) {
      const std::string right = std::string(name.substr(0, name.size() - 4)) + "Right";
      EXPECT_TRUE(names.contains(right)) << name;
    }
  }
}

TEST(Names, LandmarkCountMatchesTheTable) {
  std::ifstream table(MIEN_SOURCE_DIR "/models/landmarks.json");
  std::stringstream text;
  text << table.rdbuf();
  const std::string json = text.str();
  int points = 0;
  for (std::size_t at = json.find("\"name\""); at != std::string::npos;
       at = json.find("\"name\"", at + 1)) {
    ++points;
  }
  EXPECT_EQ(points, mien_landmark_count());
}

TEST(Names, StatusAndStages) {
  EXPECT_STREQ(mien_face_status_name(MIEN_FACE_SEARCHING), "searching");
  EXPECT_STREQ(mien_face_status_name(MIEN_FACE_TRACKING), "tracking");
  EXPECT_STREQ(mien_face_status_name(MIEN_FACE_LOST), "lost");
  EXPECT_EQ(mien_face_status_name(3), nullptr);
  std::set<std::string> stages;
  for (int i = 0; i < MIEN_STAGE_COUNT; ++i) {
    ASSERT_NE(mien_stage_name(i), nullptr);
    EXPECT_TRUE(stages.insert(mien_stage_name(i)).second);
  }
  EXPECT_EQ(mien_stage_name(MIEN_STAGE_COUNT), nullptr);
  EXPECT_EQ(mien_stage_name(-1), nullptr);
}

TEST(Names, VersionsAgree) {
  const std::uint32_t api = mien_version_api();
  EXPECT_EQ(api, std::uint32_t{MIEN_API_VERSION});
  std::ostringstream expected;
  expected << (api >> 16) << '.' << (api >> 8 & 0xFF) << '.' << (api & 0xFF);
  EXPECT_EQ(mien_version(), expected.str());
}

TEST(Names, Tiers) {
  EXPECT_TRUE(mien_cpu_tiers() & MIEN_CPU_REF);
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_REF), "ref");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_AVX2), "avx2");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_AVX512_FP16), "avx512fp16");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_AVX512_VNNI), "avx512vnni");
  EXPECT_EQ(std::uint32_t{MIEN_CPU_HALF}, kernels::kHalfTiers);
  EXPECT_EQ(mien_cpu_tier_name(0), nullptr);
  EXPECT_EQ(mien_cpu_tier_name(MIEN_CPU_REF | MIEN_CPU_AVX2), nullptr);
  EXPECT_EQ(mien_cpu_tier_name(MIEN_CPU_FUSED), nullptr);  // not a tier
  EXPECT_FALSE(mien_cpu_tiers() & MIEN_CPU_FUSED);
  EXPECT_EQ(mien_cpu_tier_name(0x80000000u), nullptr);
}

}  // namespace
}  // namespace mien::tests
