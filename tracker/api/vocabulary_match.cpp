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

// With fewer matches, names such as "A" are probably not visemes or vowels, and what precedes
// names is probably no prefix.
constexpr int kMinNames = 3;

constexpr std::size_t kMaxSpelling = 64;  // bounds the time that long names take

using Names = std::span<const char* const>;
using Vocabularies = std::span<const std::int32_t>;
constexpr std::array<std::int32_t, 2> kFaces = {MIEN_VOCABULARY_ARKIT, MIEN_VOCABULARY_ROBLOX};

struct Match {
  std::int32_t vocabulary = -1;  // -1: none
  std::int32_t index = -1;
  friend bool operator==(const Match&, const Match&) = default;
};

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

bool is_name(std::int32_t vocabulary, std::int32_t index, std::string_view plain) {
  const auto value = static_cast<std::size_t>(index);
  return is_spelling(mien_vocabulary_name(vocabulary, index), plain) ||
         (vocabulary == MIEN_VOCABULARY_VISEMES && is_viseme(value, plain)) ||
         (vocabulary == MIEN_VOCABULARY_VRM0 && is_spelling(kVroidNames[value], plain));
}

// In the first of the vocabularies that has the name.
Match match_of(std::string_view name, Vocabularies vocabularies) {
  const formats::PlainName plain_name(name);
  const std::string_view plain = plain_name.text();
  if (plain.empty()) {
    return {};
  }
  for (const std::int32_t vocabulary : vocabularies) {
    for (std::int32_t i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
      if (is_name(vocabulary, i, plain)) {
        return {vocabulary, i};
      }
    }
  }
  return {};
}

// Whether enough different names of the vocabularies follow the prefix.
bool is_shared(std::string_view prefix, Names names, Vocabularies vocabularies) {
  std::array<Match, kMinNames> found = {};
  std::size_t count = 0;
  for (const char* name : names) {
    const std::string_view text = formats::without_path(name);
    if (!text.starts_with(prefix)) {
      continue;
    }
    const Match match = match_of(text.substr(prefix.size()), vocabularies);
    if (std::find(found.begin(), found.end(), match) == found.end()) {
      found[count] = match;
      if (++count == found.size()) {
        return true;
      }
    }
  }
  return false;
}

// Behind the shortest prefix that ends in an underscore and that several of the names share.
Match match_behind_prefix(std::string_view name, Names names, Vocabularies vocabularies) {
  const std::string_view text = formats::without_path(name);
  std::size_t from = text.size() - std::min(text.size(), kMaxSpelling);
  while ((from = text.find('_', from)) != std::string_view::npos) {
    ++from;
    const Match match = match_of(text.substr(from), vocabularies);
    if (match != Match() && is_shared(text.substr(0, from), names, vocabularies)) {
      return match;
    }
  }
  return {};
}

struct Lookup {
  Vocabularies vocabularies;
  bool behind_prefixes = false;

  [[nodiscard]] Match operator()(const char* name, Names names) const {
    return behind_prefixes ? match_behind_prefix(name, names, vocabularies)
                           : match_of(name, vocabularies);
  }
};

struct Matches {
  Names names;
  std::int32_t* vocabularies;
  std::int32_t* indices;

  // Looks for the targets that have no match.
  void add(const Lookup& lookup) const {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (indices[i] < 0) {
        const Match match = lookup(names[i], names);
        vocabularies[i] = match.vocabulary;
        indices[i] = match.index;
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
int count_of(Names names, const Lookup& lookup) {
  std::uint64_t found = 0;
  for (const char* name : names) {
    const std::int32_t index = lookup(name, names).index;
    found |= index >= 0 ? 1ull << index : 0;
  }
  return std::popcount(found);
}

// The vocabulary, other than those of faces, that has most of the names; of none if none has
// enough. Short names are not looked for behind prefixes if the vocabulary is there without one:
// VRoid's parts of the face have prefixes.
Lookup mouth_lookup(Names names) {
  static constexpr std::array<std::int32_t, 3> kMouths = {
      MIEN_VOCABULARY_VISEMES, MIEN_VOCABULARY_VRM1, MIEN_VOCABULARY_VRM0};
  Lookup best;
  int most = kMinNames - 1;
  for (const std::int32_t& vocabulary : kMouths) {
    Lookup lookup = {{&vocabulary, 1}};
    int count = count_of(names, lookup);
    if (count < kMinNames) {
      lookup.behind_prefixes = true;
      count = count_of(names, lookup);
    }
    if (count > most) {
      best = lookup;
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
  matches.add({mien::tracker::kFaces});
  matches.add({mien::tracker::kFaces, true});
  if (!matches.open_jaw()) {
    matches.add(mien::tracker::mouth_lookup(matches.names));
  }
  return MIEN_OK;
}
