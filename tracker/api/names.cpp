// C API: version, names and counts.
#include <mien/mien.h>

#include <cstdint>
#include <iterator>

#include "kernels/families.h"
#include "kernels/float_mode.h"
#include "kernels/registry.h"
#include "kernels/tier.h"
#include "tracker/decoders/controls.h"
#include "tracker/encoders/landmarks.h"

static_assert(MIEN_CONTROL_COUNT == mien::tracker::kControls);
static_assert(MIEN_LANDMARK_GROUP_COUNT == std::size(mien::tracker::kLandmarkGroups));

namespace {

const mien::tracker::LandmarkGroup* landmark_group(int32_t group) {
  return group >= 0 && group < MIEN_LANDMARK_GROUP_COUNT ? mien::tracker::kLandmarkGroups + group
                                                         : nullptr;
}

}  // namespace

const char* mien_version(void) { return MIEN_VERSION; }

uint32_t mien_version_api(void) { return MIEN_API_VERSION; }

uint32_t mien_cpu_tiers(void) { return mien::kernels::detect_cpu(); }

const char* mien_cpu_tier_name(uint32_t tier) {
  for (std::uint32_t i = 0; i < mien::kernels::kTierCount; ++i) {
    const auto candidate = static_cast<mien::kernels::Tier>(i);
    if (tier == mien::kernels::bit(candidate)) {
      return mien::kernels::name(candidate);
    }
  }
  return nullptr;
}

int64_t mien_cpu_multiply_adds(uint32_t cpu_mask, int64_t rounds) {
  const auto loop = mien::kernels::find<mien::kernels::FmaPeakArgs>(cpu_mask);
  if (loop == nullptr || rounds < 1) {
    return 0;
  }
  float sums[8];
  std::int64_t macs = 0;
  const mien::kernels::FloatMode float_mode;
  loop({sums, rounds, &macs});
  return macs;
}

const char* mien_control_name(int32_t control) {
  const bool known = control >= 0 && control < mien::tracker::kControls;
  return known ? mien::tracker::kControlNames[static_cast<std::size_t>(control)] : nullptr;
}

const char* mien_landmark_group_name(int32_t group) {
  const mien::tracker::LandmarkGroup* found = landmark_group(group);
  return found != nullptr ? found->name : nullptr;
}

int32_t mien_landmark_group_range(int32_t group, int32_t* first) {
  const mien::tracker::LandmarkGroup* found = landmark_group(group);
  if (first != nullptr) {
    *first = found != nullptr ? found->first : 0;
  }
  return found != nullptr ? found->count : 0;
}

int32_t mien_control_count(void) { return MIEN_CONTROL_COUNT; }

int32_t mien_landmark_count(void) { return MIEN_LANDMARK_COUNT; }

const char* mien_face_status_name(int32_t status) {
  switch (status) {
    case MIEN_FACE_SEARCHING:
      return "searching";
    case MIEN_FACE_TRACKING:
      return "tracking";
    case MIEN_FACE_LOST:
      return "lost";
    default:
      return nullptr;
  }
}

const char* mien_stage_name(int32_t stage) {
  switch (stage) {
    case MIEN_STAGE_PROPOSAL:
      return "proposal";
    case MIEN_STAGE_WARP:
      return "warp";
    case MIEN_STAGE_ENCODER:
      return "encoder";
    case MIEN_STAGE_HEADS:
      return "heads";
    case MIEN_STAGE_DECODERS:
      return "decoders";
    case MIEN_STAGE_SOUND:
      return "sound";
    default:
      return nullptr;
  }
}
