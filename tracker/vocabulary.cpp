// The part of the C interface that speaks other vocabularies.
#include <mien/mien.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "kernels/float_mode.h"
#include "tracker/vocabulary_tables.h"

namespace mien::tracker {
namespace {

// Empty for numbers that are no mien_vocabulary.
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
    case MIEN_VOCABULARY_VISEMES:
      return kVisemeRows;
    default:
      return {};
  }
}

std::span<const std::size_t> controls_of(const VocabularyRow& row) {
  return std::span(row.controls).first(row.count);
}

float value_of(const VocabularyRow& row, const float* controls) {
  float sum = 0.0f, largest = 0.0f, least = 1.0f;
  for (const std::size_t control : controls_of(row)) {
    const float value = std::clamp(controls[control], 0.0f, 1.0f);
    sum += value;
    largest = std::max(largest, value);
    least = std::min(least, value);
  }
  if (row.count == 0) {
    return 0.0f;
  }
  switch (row.making) {
    case Making::kLargest:
      return largest;
    case Making::kLeast:
      return least;
    default:
      return sum / static_cast<float>(row.count);
  }
}

// Whether all that it needs is there: of what is the largest, any of it.
bool is_driven(const VocabularyRow& row, std::uint64_t supported) {
  const auto there = [supported](std::size_t control) { return (supported >> control & 1u) != 0; };
  const auto controls = controls_of(row);
  return row.making == Making::kLargest
             ? std::any_of(controls.begin(), controls.end(), there)
             : row.count > 0 && std::all_of(controls.begin(), controls.end(), there);
}

}  // namespace
}  // namespace mien::tracker

using mien::tracker::Making;
using mien::tracker::VocabularyRow;

int32_t mien_vocabulary_size(int32_t vocabulary) {
  return static_cast<std::int32_t>(mien::tracker::rows_of(vocabulary).size());
}

const char* mien_vocabulary_name(int32_t vocabulary, int32_t index) {
  const auto rows = mien::tracker::rows_of(vocabulary);
  const bool known = index >= 0 && static_cast<std::size_t>(index) < rows.size();
  return known ? rows[static_cast<std::size_t>(index)].name : nullptr;
}

mien_status mien_vocabulary_values(int32_t vocabulary, const float* controls, float* values,
                                   int32_t count) {
  const auto rows = mien::tracker::rows_of(vocabulary);
  if (controls == nullptr || values == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (rows.empty() || count != mien_vocabulary_size(vocabulary)) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  const mien::kernels::FloatMode ours;
  std::transform(rows.begin(), rows.end(), values,
                 [&](const VocabularyRow& row) { return mien::tracker::value_of(row, controls); });
  const float largest = *std::max_element(values, values + count);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    values[i] = rows[i].making == Making::kRest ? 1.0f - largest : values[i];
  }
  return MIEN_OK;
}

uint64_t mien_vocabulary_supported(int32_t vocabulary, uint64_t supported_controls) {
  const auto rows = mien::tracker::rows_of(vocabulary);
  std::uint64_t supported = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    supported |= mien::tracker::is_driven(rows[i], supported_controls) ? 1ull << i : 0;
  }
  const auto rest = std::find_if(rows.begin(), rows.end(), [](const VocabularyRow& row) {
    return row.making == Making::kRest;
  });
  return rest != rows.end() && supported != 0 ? supported | 1ull << (rest - rows.begin())
                                              : supported;
}
