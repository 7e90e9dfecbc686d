// C API: neutral calibration.
#include <mien/mien.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "formats/neutral_file.h"
#include "kernels/float_mode.h"
#include "tracker/api/tracker_handle.h"
#include "tracker/decoders/neutral.h"
#include "tracker/encoders/levels.h"

namespace {

using mien::formats::NeutralFile;
using mien::tracker::kControls;

static_assert(MIEN_NEUTRAL_BYTES == mien::formats::kNeutralFileBytes);
static_assert(mien::formats::kNeutralLevels / 2 == kControls);

// For each part of a neutral file, a level of detail that uses its decoder.
constexpr std::int32_t kLevelOfPart[] = {mien::tracker::kMinLevel, mien::tracker::kMaxLevel};

std::span<float, kControls> levels(NeutralFile& file, std::size_t part) {
  return std::span<float, kControls>(file.levels + part * kControls, kControls);
}

mien_status check(const mien_tracker* tracker) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  return tracker->tracker.faces().all().size() == 1 ? MIEN_OK : MIEN_ERROR_SEVERAL_FACES;
}

}  // namespace

mien_status mien_tracker_capture_neutral(mien_tracker* tracker) {
  const mien_status status = check(tracker);
  if (status == MIEN_OK) {
    tracker->tracker.capture_neutral();
  }
  return status;
}

mien_status mien_tracker_save_neutral(const mien_tracker* tracker, void* file, size_t file_bytes,
                                      uint32_t* captured) {
  const mien_status status = file != nullptr ? check(tracker) : MIEN_ERROR_NULL_ARGUMENT;
  if (status != MIEN_OK) {
    return status;
  }
  if (file_bytes < MIEN_NEUTRAL_BYTES) {
    return MIEN_ERROR_MEMORY_TOO_SMALL;
  }
  NeutralFile saved;
  for (std::size_t part = 0; part < std::size(kLevelOfPart); ++part) {
    const mien::tracker::Neutral& neutral = tracker->tracker.neutral(kLevelOfPart[part]);
    saved.captured |= static_cast<std::uint32_t>(neutral.is_captured()) << part;
    std::copy(neutral.levels().begin(), neutral.levels().end(), levels(saved, part).begin());
  }
  mien::formats::write_neutral_file(saved, std::span<std::byte, MIEN_NEUTRAL_BYTES>(
                                               static_cast<std::byte*>(file), MIEN_NEUTRAL_BYTES));
  if (captured != nullptr) {
    *captured = saved.captured;
  }
  return MIEN_OK;
}

mien_status mien_tracker_load_neutral(mien_tracker* tracker, const void* file, size_t file_bytes) {
  const mien_status status = file != nullptr ? check(tracker) : MIEN_ERROR_NULL_ARGUMENT;
  if (status != MIEN_OK) {
    return status;
  }
  const mien::kernels::FloatMode float_mode;
  NeutralFile loaded;
  const mien_status error =
      mien::formats::read_neutral_file({static_cast<const std::byte*>(file), file_bytes}, loaded);
  for (std::size_t part = 0; error == MIEN_OK && part < std::size(kLevelOfPart); ++part) {
    if ((loaded.captured >> part & 1u) != 0) {
      tracker->tracker.neutral(kLevelOfPart[part]).set(levels(loaded, part));
    }
  }
  return error;
}
