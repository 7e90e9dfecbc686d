// C API: controls in other vocabularies.
#include <mien/mien.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "formats/vocabulary/visemes.h"
#include "kernels/float_mode.h"
#include "tracker/api/vocabulary_tables.h"

namespace mien::tracker {
namespace {

// Empty for an undefined mien_vocabulary, and for visemes, which are not computed from rows.
std::span<const VocabularyRow> rows_of(std::int32_t vocabulary) {
  switch (vocabulary) {
    case MIEN_VOCABULARY_ARKIT:
      return kArkitRows;
    case MIEN_VOCABULARY_MEDIAPIPE:
      return kMediaPipeRows;
    case MIEN_VOCABULARY_ROBLOX:
      return kRobloxRows;
    case MIEN_VOCABULARY_VRM0:
      return kVrm0Rows;
    case MIEN_VOCABULARY_VRM1:
      return kVrm1Rows;
    default:
      return {};
  }
}

std::span<const std::size_t> controls_of(const VocabularyRow& row) {
  return std::span(row.controls).first(row.count);
}

float value_of(const VocabularyRow& row, const float* controls) {
  float sum = 0.0f, max = 0.0f, min = 1.0f;
  for (const std::size_t control : controls_of(row)) {
    const float value = std::clamp(controls[control], 0.0f, 1.0f);
    sum += value;
    max = std::max(max, value);
    min = std::min(min, value);
  }
  if (row.count == 0) {
    return 0.0f;
  }
  switch (row.combination) {
    case Combination::kMax:
      return max;
    case Combination::kMin:
      return min;
    default:
      return sum / static_cast<float>(row.count);
  }
}

bool all_supported(std::span<const std::size_t> controls, std::uint64_t supported) {
  return std::all_of(controls.begin(), controls.end(),
                     [supported](std::size_t control) { return (supported >> control & 1u) != 0; });
}

// A maximum needs any of its controls, other combinations all of them.
bool is_supported(const VocabularyRow& row, std::uint64_t supported) {
  const auto has = [supported](std::size_t control) { return (supported >> control & 1u) != 0; };
  const auto controls = controls_of(row);
  return row.combination == Combination::kMax ? std::any_of(controls.begin(), controls.end(), has)
                                              : row.count > 0 && all_supported(controls, supported);
}

void visemes_of(const float* controls, float* values) {
  std::array<double, formats::kControlCount> mouth;
  std::transform(controls, controls + mouth.size(), mouth.begin(),
                 [](float value) { return static_cast<double>(std::clamp(value, 0.0f, 1.0f)); });
  const auto visemes = formats::visemes_of(mouth);
  std::transform(visemes.begin(), visemes.end(), values,
                 [](double value) { return static_cast<float>(value); });
}

// Visemes whose leading controls are supported, and silence if there is any of these.
std::uint64_t visemes_supported(std::uint64_t supported) {
  std::uint64_t visemes = 0;
  for (std::size_t i = 1; i < formats::kVisemeCount; ++i) {
    visemes |= all_supported(formats::leading_controls(i), supported) ? 1ull << i : 0;
  }
  return visemes != 0 ? visemes | 1u : 0;
}

}  // namespace
}  // namespace mien::tracker

using mien::tracker::VocabularyRow;

int32_t mien_vocabulary_size(int32_t vocabulary) {
  if (vocabulary == MIEN_VOCABULARY_VISEMES) {
    return mien::formats::kVisemeCount;
  }
  return static_cast<std::int32_t>(mien::tracker::rows_of(vocabulary).size());
}

const char* mien_vocabulary_name(int32_t vocabulary, int32_t index) {
  if (index < 0 || index >= mien_vocabulary_size(vocabulary)) {
    return nullptr;
  }
  const auto i = static_cast<std::size_t>(index);
  return vocabulary == MIEN_VOCABULARY_VISEMES ? mien::formats::kVisemeNames[i].data()
                                               : mien::tracker::rows_of(vocabulary)[i].name;
}

mien_status mien_vocabulary_values(int32_t vocabulary, const float* controls, float* values,
                                   int32_t count) {
  if (controls == nullptr || values == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (count != mien_vocabulary_size(vocabulary) || count == 0) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  const mien::kernels::FloatMode float_mode;
  if (vocabulary == MIEN_VOCABULARY_VISEMES) {
    mien::tracker::visemes_of(controls, values);
    return MIEN_OK;
  }
  const auto rows = mien::tracker::rows_of(vocabulary);
  std::transform(rows.begin(), rows.end(), values,
                 [&](const VocabularyRow& row) { return mien::tracker::value_of(row, controls); });
  return MIEN_OK;
}

uint64_t mien_vocabulary_supported(int32_t vocabulary, uint64_t supported_controls) {
  if (vocabulary == MIEN_VOCABULARY_VISEMES) {
    return mien::tracker::visemes_supported(supported_controls);
  }
  const auto rows = mien::tracker::rows_of(vocabulary);
  std::uint64_t supported = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    supported |= mien::tracker::is_supported(rows[i], supported_controls) ? 1ull << i : 0;
  }
  return supported;
}
