// Tests of other vocabularies: names, order, and values computed from controls.
#include <gtest/gtest.h>
#include <mien/mien.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "formats/vocabulary/visemes.h"

namespace mien::tests {
namespace {

using Controls = std::array<float, MIEN_CONTROL_COUNT>;

constexpr int kAll[] = {MIEN_VOCABULARY_ARKIT, MIEN_VOCABULARY_MEDIAPIPE, MIEN_VOCABULARY_ROBLOX,
                        MIEN_VOCABULARY_VRM0,  MIEN_VOCABULARY_VRM1,      MIEN_VOCABULARY_VISEMES};
constexpr std::uint64_t kAllControls = (1ull << MIEN_CONTROL_COUNT) - 1;

int control(const std::string& name) {
  int i = 0;
  while (name != mien_control_name(i)) {
    ++i;
  }
  return i;
}

int index_of(int vocabulary, const std::string& name) {
  for (int i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
    if (name == mien_vocabulary_name(vocabulary, i)) {
      return i;
    }
  }
  ADD_FAILURE() << name;
  return 0;
}

std::vector<float> values_of(int vocabulary, const Controls& controls) {
  std::vector<float> values(static_cast<std::size_t>(mien_vocabulary_size(vocabulary)), -1.0f);
  EXPECT_EQ(mien_vocabulary_values(vocabulary, controls.data(), values.data(),
                                   static_cast<int>(values.size())),
            MIEN_OK);
  return values;
}

float value_of(int vocabulary, const Controls& controls, const std::string& name) {
  return values_of(vocabulary, controls)[static_cast<std::size_t>(index_of(vocabulary, name))];
}

Controls with(std::initializer_list<std::pair<const char*, float>> set) {
  Controls controls = {};
  for (const auto& [name, value] : set) {
    controls[static_cast<std::size_t>(control(name))] = value;
  }
  return controls;
}

TEST(Vocabulary, SizesAndNames) {
  const int sizes[] = {52, 52, 50, 11, 11, 15};
  for (const int vocabulary : kAll) {
    EXPECT_EQ(mien_vocabulary_size(vocabulary), sizes[vocabulary]);
    EXPECT_EQ(mien_vocabulary_name(vocabulary, -1), nullptr);
    EXPECT_EQ(mien_vocabulary_name(vocabulary, sizes[vocabulary]), nullptr);
  }
  for (const int other : {-1, 6}) {
    EXPECT_EQ(mien_vocabulary_size(other), 0);
    EXPECT_EQ(mien_vocabulary_name(other, 0), nullptr);
    EXPECT_EQ(mien_vocabulary_supported(other, kAllControls), 0u);
  }
}

TEST(Vocabulary, ArkitEqualsTheControls) {
  Controls controls;
  std::mt19937 random(1);
  std::generate(controls.begin(), controls.end(),
                [&] { return std::uniform_real_distribution<float>()(random); });
  const std::vector<float> values = values_of(MIEN_VOCABULARY_ARKIT, controls);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    EXPECT_STREQ(mien_vocabulary_name(MIEN_VOCABULARY_ARKIT, static_cast<int>(i)),
                 mien_control_name(static_cast<int>(i)));
    EXPECT_EQ(values[i], controls[i]);
  }
}

// Alphabetical after _neutral: jawOpen before jawRight, mouthPress before mouthPucker.
TEST(Vocabulary, MediaPipeIsSorted) {
  std::vector<std::string> names;
  for (int i = 1; i < 52; ++i) {
    names.emplace_back(mien_vocabulary_name(MIEN_VOCABULARY_MEDIAPIPE, i));
  }
  EXPECT_STREQ(mien_vocabulary_name(MIEN_VOCABULARY_MEDIAPIPE, 0), "_neutral");
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_EQ(std::count(names.begin(), names.end(), "tongueOut"), 0);
  for (const std::string& name : names) {
    EXPECT_EQ(value_of(MIEN_VOCABULARY_MEDIAPIPE, with({{name.c_str(), 0.6f}}), name), 0.6f);
  }
}

TEST(Vocabulary, RobloxHasTheOrderOfItsEnum) {
  const auto name = [](int i) {
    return std::string(mien_vocabulary_name(MIEN_VOCABULARY_ROBLOX, i));
  };
  EXPECT_EQ(name(0), "ChinRaiserUpperLip");
  EXPECT_EQ(name(25), "JawDrop");
  EXPECT_EQ(name(31), "LeftNoseWrinkler");
  EXPECT_EQ(name(32), "LeftInnerBrowRaiser");
  EXPECT_EQ(name(35), "RightInnerBrowRaiser");
  EXPECT_EQ(name(36), "RightNoseWrinkler");
  EXPECT_EQ(name(49), "TongueUp");
}

TEST(Vocabulary, RobloxCombinesControls) {
  constexpr int kRoblox = MIEN_VOCABULARY_ROBLOX;
  const Controls looks = with({{"eyeLookOutLeft", 0.8f}, {"eyeLookInRight", 0.4f}});
  EXPECT_FLOAT_EQ(value_of(kRoblox, looks, "EyesLookLeft"), 0.6f);
  EXPECT_EQ(value_of(kRoblox, looks, "EyesLookRight"), 0.0f);
  const Controls cheeks = with({{"eyeSquintLeft", 0.2f}, {"cheekSquintLeft", 0.7f}});
  EXPECT_EQ(value_of(kRoblox, cheeks, "LeftCheekRaiser"), 0.7f);
  EXPECT_EQ(value_of(kRoblox, cheeks, "RightCheekRaiser"), 0.0f);
  const Controls brows = with({{"browDownLeft", 0.9f}, {"browDownRight", 0.3f}});
  EXPECT_EQ(value_of(kRoblox, brows, "Corrugator"), 0.3f);
  EXPECT_EQ(value_of(kRoblox, brows, "LeftBrowLowerer"), 0.9f);
  const std::uint64_t supported_names = mien_vocabulary_supported(kRoblox, kAllControls);
  for (const char* unsupported : {"FlatPucker", "TongueUp", "TongueDown"}) {
    EXPECT_EQ(supported_names >> index_of(kRoblox, unsupported) & 1u, 0u) << unsupported;
  }
}

// Swapping left and right of the controls swaps left and right of the names.
TEST(Vocabulary, LeftAndRightAreTheSubjects) {
  const auto mirrored = [](std::string name) {
    for (const auto& [from, to] : {std::pair{"Left", "Right"}, {"Right", "Left"}}) {
      const std::size_t at = name.find(from);
      if (at != std::string::npos) {
        return name.replace(at, std::string(from).size(), to);
      }
    }
    return name;
  };
  std::mt19937 random(2);
  Controls controls, other;
  std::generate(controls.begin(), controls.end(),
                [&] { return std::uniform_real_distribution<float>()(random); });
  for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
    other[static_cast<std::size_t>(control(mirrored(mien_control_name(i))))] =
        controls[static_cast<std::size_t>(i)];
  }
  for (const int vocabulary : {MIEN_VOCABULARY_MEDIAPIPE, MIEN_VOCABULARY_ROBLOX}) {
    for (int i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
      const std::string name = mien_vocabulary_name(vocabulary, i);
      EXPECT_EQ(value_of(vocabulary, controls, name), value_of(vocabulary, other, mirrored(name)))
          << name;
    }
  }
}

TEST(Vocabulary, ValuesAreBetweenZeroAndOne) {
  for (const float all : {0.0f, 0.5f, 1.0f, -3.0f, 40.0f}) {
    Controls controls;
    controls.fill(all);
    for (const int vocabulary : kAll) {
      for (const float value : values_of(vocabulary, controls)) {
        EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << vocabulary << ": " << value;
      }
    }
  }
}

// `mien track --format visemes` uses the same functions.
TEST(Vocabulary, VisemesMatchTheFileFormats) {
  constexpr int kVisemes = MIEN_VOCABULARY_VISEMES;
  EXPECT_EQ(value_of(kVisemes, {}, "sil"), 1.0f);
  for (std::size_t i = 1; i < formats::kVisemeCount; ++i) {
    std::array<double, formats::kVisemeCount> alone = {};
    alone[i] = 1.0;
    const auto pose = formats::controls_of_visemes(alone);
    Controls controls = {};
    std::transform(pose.begin(), pose.end(), controls.begin(),
                   [](double value) { return static_cast<float>(formats::or_zero(value)); });
    EXPECT_NEAR(value_of(kVisemes, controls, formats::kVisemeNames[i].data()), 1.0f, 1e-5f);
  }
  std::mt19937 random(3);
  for (int times = 0; times < 100; ++times) {
    Controls controls;
    std::generate(controls.begin(), controls.end(),
                  [&] { return std::uniform_real_distribution<float>()(random); });
    std::array<double, formats::kControlCount> same;
    std::copy(controls.begin(), controls.end(), same.begin());
    const auto expected = formats::visemes_of(same);
    const std::vector<float> values = values_of(kVisemes, controls);
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_EQ(values[i], static_cast<float>(expected[i]));
    }
    EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 1.0, 1e-5);
  }
}

TEST(Vocabulary, VisemesNeedTheirLeadingControls) {
  const auto supported_visemes = [](std::initializer_list<const char*> controls) {
    std::uint64_t supported = 0;
    for (const char* name : controls) {
      supported |= 1ull << control(name);
    }
    return mien_vocabulary_supported(MIEN_VOCABULARY_VISEMES, supported);
  };
  const auto bit = [](const char* name) { return 1ull << index_of(MIEN_VOCABULARY_VISEMES, name); };
  EXPECT_EQ(supported_visemes({"mouthPucker"}), bit("sil") | bit("RR") | bit("ou"));
  EXPECT_EQ(supported_visemes({"mouthPressLeft"}), 0u) << "PP presses both sides";
  EXPECT_EQ(supported_visemes({"mouthPressLeft", "mouthPressRight"}), bit("sil") | bit("PP"));
  EXPECT_EQ(mien_vocabulary_supported(MIEN_VOCABULARY_VISEMES, kAllControls), 0x7fffu);
}

TEST(Vocabulary, SupportFollowsTheControls) {
  EXPECT_EQ(mien_vocabulary_supported(MIEN_VOCABULARY_ARKIT, kAllControls), kAllControls);
  EXPECT_EQ(mien_vocabulary_supported(MIEN_VOCABULARY_VISEMES, 0), 0u);
  const std::uint64_t left = 1ull << control("mouthSmileLeft");
  EXPECT_EQ(mien_vocabulary_supported(MIEN_VOCABULARY_VRM1, left), 0u)
      << "happy needs both corners";
  const std::uint64_t both = left | 1ull << control("mouthSmileRight");
  EXPECT_EQ(mien_vocabulary_supported(MIEN_VOCABULARY_VRM1, both), 1u);
  const auto raises = [](std::uint64_t supported) {
    return mien_vocabulary_supported(MIEN_VOCABULARY_ROBLOX, supported) >>
               index_of(MIEN_VOCABULARY_ROBLOX, "LeftCheekRaiser") &
           1u;
  };
  EXPECT_EQ(raises(left), 0u);
  EXPECT_EQ(raises(1ull << control("cheekSquintLeft")), 1u) << "a maximum needs one control";
}

TEST(Vocabulary, RejectsInvalidArguments) {
  float controls[MIEN_CONTROL_COUNT] = {}, values[52];
  EXPECT_EQ(mien_vocabulary_values(MIEN_VOCABULARY_VRM0, controls, values, 12),
            MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_vocabulary_values(6, controls, values, 0), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_vocabulary_values(0, nullptr, values, 52), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_vocabulary_values(0, controls, nullptr, 52), MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien::tests
