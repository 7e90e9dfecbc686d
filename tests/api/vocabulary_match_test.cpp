// Tests of finding names of vocabularies among those of an avatar's morph targets.
#include <gtest/gtest.h>
#include <mien/mien.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mien::tests {
namespace {

using Names = std::vector<std::string>;

// The vocabulary and the name in it for each target, such as "arkit jawOpen"; "-" for none.
Names matches(const Names& targets) {
  std::vector<const char*> texts(targets.size());
  std::transform(targets.begin(), targets.end(), texts.begin(),
                 [](const std::string& name) { return name.c_str(); });
  std::vector<std::int32_t> vocabularies(targets.size(), 99), indices(targets.size(), 99);
  EXPECT_EQ(mien_vocabulary_match(texts.data(), static_cast<std::int32_t>(texts.size()),
                                  vocabularies.data(), indices.data()),
            MIEN_OK);
  const char* const titles[] = {"arkit", "mediapipe", "roblox", "vrm0", "vrm1", "visemes"};
  Names found;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (vocabularies[i] == -1) {
      EXPECT_EQ(indices[i], -1);
      found.emplace_back("-");
    } else {
      const char* name = mien_vocabulary_name(vocabularies[i], indices[i]);
      found.push_back(std::string(titles[vocabularies[i]]) + " " + (name != nullptr ? name : "?"));
    }
  }
  return found;
}

Names names_of(int vocabulary) {
  Names names;
  for (std::int32_t i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
    names.emplace_back(mien_vocabulary_name(vocabulary, i));
  }
  return names;
}

Names with_prefix(const std::string& prefix, Names names) {
  for (std::string& name : names) {
    name.insert(0, prefix);
  }
  return names;
}

TEST(VocabularyMatch, FindsEveryNameOfAVocabulary) {
  for (const auto& [vocabulary, title] :
       {std::pair{MIEN_VOCABULARY_ARKIT, "arkit "}, std::pair{MIEN_VOCABULARY_VRM0, "vrm0 "},
        std::pair{MIEN_VOCABULARY_VRM1, "vrm1 "}, std::pair{MIEN_VOCABULARY_VISEMES, "visemes "}}) {
    const Names names = names_of(vocabulary);
    EXPECT_EQ(matches(names), with_prefix(title, names));
  }
  for (const std::string& name : names_of(MIEN_VOCABULARY_ROBLOX)) {
    EXPECT_NE(matches({name}), Names{"-"}) << name;
  }
}

TEST(VocabularyMatch, IgnoresPrefixesCaseAndPunctuation) {
  EXPECT_EQ(matches({"Face.M_F.jawOpen", "head:MouthSmileRight", "Body|EYE_BLINK_L", "mouthSmile_l",
                     "cheek-puff \xC3\xA9", "jawOpen.001", "Custom", ""}),
            (Names{"arkit jawOpen", "arkit mouthSmileRight", "arkit eyeBlinkLeft",
                   "arkit mouthSmileLeft", "arkit cheekPuff", "-", "-", "-"}));
}

TEST(VocabularyMatch, PrefersArkitToRoblox) {
  EXPECT_EQ(matches({"JawDrop", "LeftEyeClosed", "MouthLeft"}),
            (Names{"roblox JawDrop", "roblox LeftEyeClosed", "arkit mouthLeft"}));
}

TEST(VocabularyMatch, FindsVisemesOfReadyPlayerMeAndVrchat) {
  EXPECT_EQ(matches({"viseme_I", "viseme_E", "viseme_PP", "vrc.v_aa", "v_ou"}),
            (Names{"visemes ih", "visemes E", "visemes PP", "visemes aa", "visemes ou"}));
}

TEST(VocabularyMatch, FindsTargetsOfVroid) {
  EXPECT_EQ(matches({"Fcl_MTH_A", "Fcl_ALL_Joy", "Fcl_EYE_Close_R", "Fcl_HA_Hide"}),
            (Names{"vrm0 A", "vrm0 Joy", "vrm0 Blink_R", "-"}));
}

TEST(VocabularyMatch, SkipsPrefixesThatThreeNamesShare) {
  EXPECT_EQ(matches({"Body.Head_jawOpen", "Body.Head_mouthSmile_L", "Tongue.Head_EyeBlinkLeft",
                     "Head_Custom", "Teeth_jawOpen", "cheekPuff"}),
            (Names{"arkit jawOpen", "arkit mouthSmileLeft", "arkit eyeBlinkLeft", "-", "-",
                   "arkit cheekPuff"}));
  EXPECT_EQ(matches({"LOD0_My_Head_jawOpen", "LOD0_My_Head_JawDrop", "LOD0_My_Head_jawLeft"}),
            (Names{"arkit jawOpen", "roblox JawDrop", "arkit jawLeft"}));
  EXPECT_EQ(matches({"Head_jawOpen", "Head_jawopen", "Head_mouthFunnel", "Hat_jawLeft"}),
            (Names{"-", "-", "-", "-"}));
}

TEST(VocabularyMatch, SkipsPrefixesOfVisemesAndVowels) {
  EXPECT_EQ(matches({"Head_viseme_aa", "Head_viseme_I", "Head_viseme_PP"}),
            (Names{"visemes aa", "visemes ih", "visemes PP"}));
  EXPECT_EQ(matches({"Mouth_A", "Mouth_I", "Mouth_U", "Mouth_wide"}),
            (Names{"vrm0 A", "vrm0 I", "vrm0 U", "-"}));
  EXPECT_EQ(matches({"Fcl_MTH_A", "Fcl_MTH_I", "Fcl_MTH_U", "Fcl_MTH_Joy"}),
            (Names{"vrm0 A", "vrm0 I", "vrm0 U", "-"}));
}

TEST(VocabularyMatch, VisemesMoveOnlyAMouthWithoutAJaw) {
  const Names visemes = {"viseme_aa", "viseme_I", "viseme_PP"};
  for (const char* jaw : {"jawOpen", "JawDrop"}) {
    Names targets = visemes;
    targets.emplace_back(jaw);
    const Names found = matches(targets);
    EXPECT_EQ(std::count(found.begin(), found.end(), "-"), 3) << jaw;
  }
  Names targets = visemes;
  targets.emplace_back("eyeBlinkLeft");
  EXPECT_EQ(matches(targets),
            (Names{"visemes aa", "visemes ih", "visemes PP", "arkit eyeBlinkLeft"}));
}

TEST(VocabularyMatch, FewNamesOfMouthsMeanSomethingElse) {
  EXPECT_EQ(matches({"A", "E", "hat"}), (Names{"-", "-", "-"}));
  EXPECT_EQ(matches({"aa", "viseme_aa", "v_aa", "E"}), (Names{"-", "-", "-", "-"}));
}

TEST(VocabularyMatch, UsesTheVocabularyWithMostNames) {
  EXPECT_EQ(matches({"aa", "ih", "ee", "happy", "E"}),
            (Names{"vrm1 aa", "vrm1 ih", "vrm1 ee", "vrm1 happy", "-"}));
}

TEST(VocabularyMatch, AcceptsLongNamesAndNone) {
  EXPECT_EQ(matches({std::string(100000, 'a'), std::string(100000, '_'), "jawOpen"}),
            (Names{"-", "-", "arkit jawOpen"}));
  EXPECT_EQ(mien_vocabulary_match(nullptr, 0, nullptr, nullptr), MIEN_OK);
}

TEST(VocabularyMatch, RejectsWrongArguments) {
  const char* names[] = {"jawOpen", nullptr};
  std::int32_t vocabularies[] = {7, 7}, indices[] = {7, 7};
  EXPECT_EQ(mien_vocabulary_match(names, -1, vocabularies, indices), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_vocabulary_match(names, 2, vocabularies, indices), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_vocabulary_match(nullptr, 1, vocabularies, indices), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_vocabulary_match(names, 1, nullptr, indices), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_vocabulary_match(names, 1, vocabularies, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(vocabularies[0], 7);
  EXPECT_EQ(indices[0], 7);
}

}  // namespace
}  // namespace mien::tests
