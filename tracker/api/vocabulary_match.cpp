// C API: the names of vocabularies that morph targets of avatars have, in the spellings of avatars.
#include <mien/mien.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

#include "formats/vocabulary/plain_name.h"
#include "formats/vocabulary/vocabulary.h"
#include "tracker/api/vocabulary_tables.h"

namespace mien::tracker {
namespace {

// With fewer matches, names such as "A" are probably not visemes or vowels.
constexpr int kMinMouthNames = 3;

// Morph targets of VRoid Studio, in the order of kVrm0Rows.
constexpr std::array<std::string_view, kVrm0Rows.size()> kVroidNames = {
    "Fcl_ALL_Joy", "Fcl_ALL_Angry",   "Fcl_ALL_Sorrow", "Fcl_ALL_Fun",
    "Fcl_MTH_A",   "Fcl_MTH_I",       "Fcl_MTH_U",      "Fcl_MTH_E",
    "Fcl_MTH_O",   "Fcl_EYE_Close_L", "Fcl_EYE_Close_R"};

bool is_spelling(std::string_view name, std::string_view plain) {
  return formats::PlainName(name).text() == plain;
}

// With a prefix, or as Ready Player Me spells it.
bool is_viseme(std::size_t viseme, std::string_view plain) {
  if (is_spelling(formats::kReadyPlayerMeNames[viseme], plain)) {
    return true;
  }
  for (const std::string_view prefix : {"viseme", "v"}) {
    if (plain.starts_with(prefix) &&
        is_spelling(formats::kVisemeNames[viseme], plain.substr(prefix.size()))) {
      return true;
    }
  }
  return false;
}

// The index in the vocabulary; -1 if the name is not in it.
std::int32_t index_of(const char* name, std::int32_t vocabulary) {
  const formats::PlainName plain_name{std::string_view(name)};
  const std::string_view plain = plain_name.text();
  if (plain.empty()) {
    return -1;
  }
  for (std::int32_t i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
    const auto value = static_cast<std::size_t>(i);
    if (is_spelling(mien_vocabulary_name(vocabulary, i), plain) ||
        (vocabulary == MIEN_VOCABULARY_VISEMES && is_viseme(value, plain)) ||
        (vocabulary == MIEN_VOCABULARY_VRM0 && is_spelling(kVroidNames[value], plain))) {
      return i;
    }
  }
  return -1;
}

struct Matches {
  std::span<const char* const> names;
  std::int32_t* vocabularies;
  std::int32_t* indices;

  // Gives the names of a vocabulary to targets that have none.
  void add(std::int32_t vocabulary) const {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (indices[i] < 0 && (indices[i] = index_of(names[i], vocabulary)) >= 0) {
        vocabularies[i] = vocabulary;
      }
    }
  }
  [[nodiscard]] bool open_jaw() const {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto unit = static_cast<std::size_t>(indices[i]);
      if ((vocabularies[i] == MIEN_VOCABULARY_ARKIT && indices[i] == MIEN_CONTROL_JAW_OPEN) ||
          (vocabularies[i] == MIEN_VOCABULARY_ROBLOX && unit == formats::facs_unit("JawDrop"))) {
        return true;
      }
    }
    return false;
  }
};

// Different names of a vocabulary among those of targets.
int count_of(std::span<const char* const> names, std::int32_t vocabulary) {
  std::uint64_t found = 0;
  for (const char* name : names) {
    const std::int32_t index = index_of(name, vocabulary);
    found |= index >= 0 ? 1ull << index : 0;
  }
  return std::popcount(found);
}

// The vocabulary, other than those of faces, that has most of the names; -1: none has enough.
std::int32_t mouth_vocabulary(std::span<const char* const> names) {
  std::int32_t best = -1;
  int most = kMinMouthNames - 1;
  for (const std::int32_t vocabulary :
       {MIEN_VOCABULARY_VISEMES, MIEN_VOCABULARY_VRM1, MIEN_VOCABULARY_VRM0}) {
    if (const int count = count_of(names, vocabulary); count > most) {
      best = vocabulary;
      most = count;
    }
  }
  return best;
}

}  // namespace
}  // namespace mien::tracker

mien_status mien_vocabulary_match(const char* const* names, int32_t count, int32_t* vocabularies,
                                  int32_t* indices) {
  if (count < 0) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  if (count > 0 && (names == nullptr || vocabularies == nullptr || indices == nullptr ||
                    std::find(names, names + count, nullptr) != names + count)) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien::tracker::Matches matches = {
      {names, static_cast<std::size_t>(count)}, vocabularies, indices};
  std::fill_n(vocabularies, count, -1);
  std::fill_n(indices, count, -1);
  matches.add(MIEN_VOCABULARY_ARKIT);
  matches.add(MIEN_VOCABULARY_ROBLOX);
  if (!matches.open_jaw()) {
    const std::int32_t mouth = mien::tracker::mouth_vocabulary(matches.names);
    if (mouth >= 0) {
      matches.add(mouth);
    }
  }
  return MIEN_OK;
}
