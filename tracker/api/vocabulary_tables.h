// Other vocabularies for faces, as rows: a name, and what of the 52 controls it is made of. Names
// are those of formats/animation/vocabulary.h, and Roblox' rows those of facs_rows.h, which files
// are read and written by, too. How a name is made of controls is ours where its owner does not
// say. Visemes are no rows, but mixtures: formats/animation/visemes.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "formats/animation/facs_rows.h"
#include "tracker/decoders/controls.h"

namespace mien::tracker {

enum class Making : std::uint8_t {
  kMean,     // of its controls; 0 where there are none
  kLargest,  // of them
  kLeast,    // of them
};

struct VocabularyRow {
  static constexpr std::size_t kMaxControls = 4;
  const char* name;
  Making making = Making::kMean;
  std::size_t count = 0;
  std::array<std::size_t, kMaxControls> controls = {};
};

consteval VocabularyRow row(const char* name, std::span<const std::string_view> controls,
                            Making making = Making::kMean) {
  VocabularyRow made = {name, making};
  for (const std::string_view control : controls) {
    made.controls[made.count++] = control_named(control);
  }
  return made;
}

consteval VocabularyRow row(const char* name, std::initializer_list<std::string_view> controls,
                            Making making = Making::kMean) {
  return row(name, std::span(controls.begin(), controls.size()), making);
}

inline constexpr auto kArkitRows = [] {
  std::array<VocabularyRow, kControls> rows = {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {kControlNames[i], Making::kMean, 1, {i}};
  }
  return rows;
}();

// ARKit's controls by their own names, and one that is none of them.
inline constexpr auto kMediaPipeRows = [] {
  std::array<VocabularyRow, formats::kMediaPipeNames.size()> rows = {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string_view name = formats::kMediaPipeNames[i];
    const std::size_t control = formats::index_of(name, formats::kArkitNames);
    rows[i] = {name.data(), Making::kMean, control < formats::kControlCount ? 1u : 0u, {control}};
  }
  return rows;
}();

constexpr Making making_of(formats::Join join) {
  return join == formats::Join::kMax   ? Making::kLargest
         : join == formats::Join::kMin ? Making::kLeast
                                       : Making::kMean;
}

inline constexpr auto kRobloxRows = [] {
  std::array<VocabularyRow, formats::kFacsCount> rows = {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].name = formats::kFacsNames[i].data();
  }
  for (const formats::FacsRow& of : formats::kFacsRows) {
    VocabularyRow& row = rows[of.unit];
    row.making = making_of(of.join);
    row.count = of.first == of.second ? 1 : 2;
    row.controls = {of.first, of.second};
  }
  return rows;
}();

// What the presets of both versions of VRM have in common.
inline constexpr std::array<std::string_view, 2> kSmile = {"mouthSmileLeft", "mouthSmileRight"};
inline constexpr std::array<std::string_view, 2> kScowl = {"browDownLeft", "browDownRight"};
inline constexpr std::array<std::string_view, 2> kFrown = {"mouthFrownLeft", "mouthFrownRight"};
inline constexpr std::array<std::string_view, 2> kSpread = {"mouthStretchLeft",
                                                            "mouthStretchRight"};
inline constexpr std::array<std::string_view, 4> kHalfOpen = {
    "mouthLowerDownLeft", "mouthLowerDownRight", "mouthUpperUpLeft", "mouthUpperUpRight"};

inline constexpr std::array kVrm0Rows = {row("Joy", kSmile),
                                         row("Angry", kScowl),
                                         row("Sorrow", kFrown),
                                         row("Fun", {}),
                                         row("A", {"jawOpen"}),
                                         row("I", kSpread),
                                         row("U", {"mouthPucker"}),
                                         row("E", kHalfOpen),
                                         row("O", {"mouthFunnel"}),
                                         row("Blink_L", {"eyeBlinkLeft"}),
                                         row("Blink_R", {"eyeBlinkRight"})};

inline constexpr std::array kVrm1Rows = {row("happy", kSmile),
                                         row("angry", kScowl),
                                         row("sad", kFrown),
                                         row("relaxed", {}),
                                         row("aa", {"jawOpen"}),
                                         row("ih", kSpread),
                                         row("ou", {"mouthPucker"}),
                                         row("ee", kHalfOpen),
                                         row("oh", {"mouthFunnel"}),
                                         row("blinkLeft", {"eyeBlinkLeft"}),
                                         row("blinkRight", {"eyeBlinkRight"})};

template <std::size_t N, std::size_t M>
consteval bool all_are_in(const std::array<VocabularyRow, N>& rows,
                          const std::array<std::string_view, M>& names) {
  return std::all_of(rows.begin(), rows.end(), [&](const VocabularyRow& row) {
    return std::find(names.begin(), names.end(), row.name) != names.end();
  });
}
static_assert(all_are_in(kVrm0Rows, formats::kVrm0Names));
static_assert(all_are_in(kVrm1Rows, formats::kVrm1Names));

}  // namespace mien::tracker
