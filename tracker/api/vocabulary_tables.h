// Other vocabularies as rows: a name, and how it is computed from the 52 controls. Names come from
// formats/vocabulary/vocabulary.h, and Roblox's rows from facs_rows.h, as in the file formats.
// Where a standard does not define the conversion, the rows are the project's choice. Visemes are
// mixtures instead of rows: formats/vocabulary/visemes.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "formats/vocabulary/facs_rows.h"
#include "tracker/decoders/controls.h"

namespace mien::tracker {

// How the values of several controls become one.
enum class Combination : std::uint8_t {
  kMean,  // 0 without controls
  kMax,
  kMin,
};

struct VocabularyRow {
  static constexpr std::size_t kMaxControls = 4;
  const char* name;
  Combination combination = Combination::kMean;
  std::size_t count = 0;
  std::array<std::size_t, kMaxControls> controls = {};
};

consteval VocabularyRow row(const char* name, std::span<const std::string_view> controls,
                            Combination combination = Combination::kMean) {
  VocabularyRow result = {name, combination};
  for (const std::string_view control : controls) {
    result.controls[result.count++] = control_named(control);
  }
  return result;
}

consteval VocabularyRow row(const char* name, std::initializer_list<std::string_view> controls,
                            Combination combination = Combination::kMean) {
  return row(name, std::span(controls.begin(), controls.size()), combination);
}

inline constexpr auto kArkitRows = [] {
  std::array<VocabularyRow, kControls> rows = {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {kControlNames[i], Combination::kMean, 1, {i}};
  }
  return rows;
}();

// ARKit's controls by name, and _neutral, which is not a control.
inline constexpr auto kMediaPipeRows = [] {
  std::array<VocabularyRow, formats::kMediaPipeNames.size()> rows = {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string_view name = formats::kMediaPipeNames[i];
    const std::size_t control = formats::index_of(name, formats::kArkitNames);
    rows[i] = {
        name.data(), Combination::kMean, control < formats::kControlCount ? 1u : 0u, {control}};
  }
  return rows;
}();

constexpr Combination combination_of(formats::Join join) {
  return join == formats::Join::kMax   ? Combination::kMax
         : join == formats::Join::kMin ? Combination::kMin
                                       : Combination::kMean;
}

inline constexpr auto kRobloxRows = [] {
  std::array<VocabularyRow, formats::kFacsCount> rows = {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].name = formats::kFacsNames[i].data();
  }
  for (const formats::FacsRow& facs : formats::kFacsRows) {
    VocabularyRow& row = rows[facs.unit];
    row.combination = combination_of(facs.join);
    row.count = facs.first == facs.second ? 1 : 2;
    row.controls = {facs.first, facs.second};
  }
  return rows;
}();

// Controls of the presets of both versions of VRM.
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
