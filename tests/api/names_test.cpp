// Tests of names, counts, versions and status messages.
#include <gtest/gtest.h>
#include <mien/mien.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/tier.h"

namespace mien::tests {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(MIEN_SOURCE_DIR "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// {"EYE_BLINK_LEFT", 0}, ...: the enumerators of the header that begin with `prefix`.
std::vector<std::pair<std::string, int>> enumerators(const std::string& prefix) {
  const std::string header = text_of("include/mien/mien.h");
  const std::regex enumerator(prefix + "([A-Z0-9_]+) = ([0-9]+)");
  std::vector<std::pair<std::string, int>> found;
  for (std::sregex_iterator at(header.begin(), header.end(), enumerator), end; at != end; ++at) {
    found.emplace_back((*at)[1], std::stoi((*at)[2]));
  }
  return found;
}

// "eyeBlinkLeft" to "EYE_BLINK_LEFT".
std::string upper_snake_case(std::string_view name) {
  std::string upper;
  for (const char c : name) {
    if (std::isupper(static_cast<unsigned char>(c)) != 0) {
      upper += '_';
    }
    upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return upper;
}

TEST(Names, EveryStatusHasItsOwnMessage) {
  std::stringstream text(text_of("include/mien/mien.h"));
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
  EXPECT_EQ(control_name(MIEN_CONTROL_JAW_OPEN), "jawOpen");
  EXPECT_EQ(control_name(MIEN_CONTROL_TONGUE_OUT), "tongueOut");
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

TEST(Names, EachControlHasItsEnumerator) {
  const auto controls = enumerators("MIEN_CONTROL_");
  ASSERT_EQ(controls.size(), 52u);
  for (const auto& [name, number] : controls) {
    EXPECT_EQ(name, upper_snake_case(control_name(number)));
  }
}

// The table of all landmarks names each "group_number".
TEST(Names, LandmarkGroupsMatchTheTable) {
  const std::string json = text_of("models/landmarks.json");
  const std::regex name(R"re("name": "(\w+)_(\d+)")re");
  std::sregex_iterator point(json.begin(), json.end(), name);
  int landmark = 0;
  for (std::int32_t group = 0; group < MIEN_LANDMARK_GROUP_COUNT; ++group) {
    std::int32_t first = -1;
    const std::int32_t count = mien_landmark_group_range(group, &first);
    EXPECT_EQ(mien_landmark_group_range(group, nullptr), count);
    EXPECT_EQ(first, landmark);
    for (std::int32_t i = 0; i < count; ++i, ++landmark, ++point) {
      ASSERT_NE(point, std::sregex_iterator());
      EXPECT_EQ((*point)[1].str(), landmark_group_name(group));
      EXPECT_EQ((*point)[2].str(), std::to_string(i));
    }
  }
  EXPECT_EQ(point, std::sregex_iterator());
  EXPECT_EQ(landmark, mien_landmark_count());
  for (const std::int32_t group : {-1, MIEN_LANDMARK_GROUP_COUNT}) {
    std::int32_t first = -1;
    EXPECT_EQ(mien_landmark_group_range(group, &first), 0);
    EXPECT_EQ(first, 0);
    EXPECT_EQ(mien_landmark_group_name(group), nullptr);
  }
}

TEST(Names, EachLandmarkGroupHasItsEnumerator) {
  const auto groups = enumerators("MIEN_LANDMARKS_");
  ASSERT_EQ(groups.size(), std::size_t{MIEN_LANDMARK_GROUP_COUNT});
  for (const auto& [name, number] : groups) {
    EXPECT_EQ(name, upper_snake_case(landmark_group_name(number)));
  }
}

TEST(Names, ResultsFindControlsAndLandmarksByName) {
  Result result;
  result.controls[MIEN_CONTROL_JAW_OPEN] = 0.5f;
  EXPECT_EQ(result.control(MIEN_CONTROL_JAW_OPEN), 0.5f);
  const auto iris = result.landmarks_of(MIEN_LANDMARKS_LEFT_IRIS);
  ASSERT_EQ(iris.size(), 5u);
  EXPECT_EQ(iris.data(), result.landmarks + 37);
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
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_AVX2_INT16), "avx2int16");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_AVX_VNNI), "avxvnni");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_WASM_INT16), "wasmint16");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_NEON_DOT), "neondot");
  EXPECT_STREQ(mien_cpu_tier_name(MIEN_CPU_NEON_I8MM), "neoni8mm");
  EXPECT_EQ(std::uint32_t{MIEN_CPU_HALF}, kernels::kHalfTiers);
  EXPECT_EQ(mien_cpu_tier_name(0), nullptr);
  EXPECT_EQ(mien_cpu_tier_name(MIEN_CPU_REF | MIEN_CPU_AVX2), nullptr);
  EXPECT_EQ(mien_cpu_tier_name(MIEN_CPU_FUSED), nullptr);  // not a tier
  EXPECT_FALSE(mien_cpu_tiers() & MIEN_CPU_FUSED);
  EXPECT_EQ(mien_cpu_tier_name(0x80000000u), nullptr);
}

TEST(Names, MultiplyAdds) {
  const std::int64_t once = mien_cpu_multiply_adds(MIEN_CPU_REF, 1);
  EXPECT_GT(once, 0);
  EXPECT_EQ(mien_cpu_multiply_adds(MIEN_CPU_REF, 10), 10 * once);
  EXPECT_EQ(mien_cpu_multiply_adds(MIEN_CPU_REF, 0), 0);
  EXPECT_EQ(mien_cpu_multiply_adds(0, 1), 0);
  EXPECT_EQ(mien_cpu_multiply_adds(~mien_cpu_tiers(), 1), 0);
}

}  // namespace
}  // namespace mien::tests
