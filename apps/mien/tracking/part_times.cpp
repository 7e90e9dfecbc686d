// Times of the tracker's parts.
#include "apps/mien/tracking/part_times.h"

#include <numeric>
#include <string_view>
#include <vector>

#include "apps/animation/numbers.h"

namespace mien::app {
namespace {

struct Part {
  std::string_view name;
  std::vector<std::size_t> stages;
};

}  // namespace

std::string part_times(const StageMs& mean, int decimals) {
  const std::array<Part, 3> parts = {{
      {"detection", {MIEN_STAGE_PROPOSAL}},
      {"face", {MIEN_STAGE_WARP, MIEN_STAGE_ENCODER, MIEN_STAGE_HEADS, MIEN_STAGE_DECODERS}},
      {"audio", {MIEN_STAGE_SOUND}},
  }};
  std::string text =
      animation::fixed(std::accumulate(mean.begin(), mean.end(), 0.0), decimals) + " ms per frame:";
  for (const Part& part : parts) {
    double ms = 0.0;
    for (const std::size_t stage : part.stages) {
      ms += mean[stage];
    }
    text.append(" ").append(part.name).append(" ").append(animation::fixed(ms, decimals));
    text += &part == &parts.back() ? "" : ",";
  }
  return text;
}

}  // namespace mien::app
