#include "tracker/mtcnn_proposal.h"

#include <algorithm>
#include <cmath>

#include "tracker/shrink.h"
#include "tracker/tiles.h"

namespace mien::tracker {
namespace {

constexpr float kPyramidFactor = 0.709f;
constexpr std::int32_t kWindow = 12;   // P-Net's, pixels
constexpr float kStride = 2.0f;        // of P-Net's windows, pixels
constexpr float kWindowMiddle = 6.0f;  // from its beginning, pixels
constexpr std::int32_t kRefineSide = 24;
constexpr float kOverlapInLevel = 0.5f;
constexpr float kOverlapOfLevels = 0.7f;
constexpr float kOverlapRefined = 0.4f;
constexpr float kLargestLogStep = 1.0f;
constexpr std::int32_t kLargestTile = 60;  // pixels

// The square that the regression (dx, dy, dlog), in sides of the window, points to.
Square regressed(const Square& window, const float* regression) {
  const float dlog = std::clamp(regression[2], -kLargestLogStep, kLargestLogStep);
  return {{window.center.x + regression[0] * window.side,
           window.center.y + regression[1] * window.side},
          window.side * std::exp(dlog)};
}

bool is_usable(const Square& square) {
  return is_finite(square.center) && std::isfinite(square.side) && square.side > 0.0f;
}

Square canvas_of(const ImageView& view) {
  return {{view.width / 2, view.height / 2}, std::max(view.width, view.height)};
}

}  // namespace

mien_status MtcnnProposal::load(const mien_tracker_config& config, const Models& models,
                                engine::Arena& arena) {
  if (!sampler_.init(config.cpu_mask)) {
    return MIEN_ERROR_UNSUPPORTED_CPU;
  }
  proposal_threshold_ = config.proposal_threshold;
  refine_threshold_ = config.refine_threshold;
  const engine::Model& model = models.proposal;
  mien_status status = MIEN_OK;
  auto size = static_cast<float>(config.proposal_size);
  tile_level_ = 0;
  for (levels_ = 0; status == MIEN_OK && levels_ < kMaxLevels; ++levels_) {
    const auto side = static_cast<std::int32_t>(std::lround(size));
    if (side < kWindow) {
      break;
    }
    status = pnets_[levels_].load(model, {"pnet", {side, side, 3}, {1, 3}}, config.cpu_mask, arena);
    tile_level_ += side > kLargestTile ? 1 : 0;
    size *= kPyramidFactor;
  }
  const engine::NetworkForm rnet = {"rnet", {kRefineSide, kRefineSide, 3}, {1, 3}};
  return status == MIEN_OK ? rnet_.load(model, rnet, config.cpu_mask, arena) : status;
}

std::size_t MtcnnProposal::propose(const ImageView& view, std::span<Candidate> found) {
  const std::span<Candidate> scanned = scan(view, canvas_of(view), 0, levels_);
  return choose(view, scanned.first(std::min(scanned.size(), kRefined)), found);
}

std::size_t MtcnnProposal::glance(const ImageView& view, std::uint32_t turn,
                                  std::span<Candidate> found) {
  Square canvas = canvas_of(view);
  std::size_t sizes = levels_ - tile_level_;
  for (std::size_t level = 0; level < tile_level_; ++level) {
    const Tiles tiles = tiles_of(view, level);
    if (turn < tiles.count()) {
      canvas = tiles.square(turn);
      sizes = 1;
      break;
    }
    turn -= tiles.count();
  }
  const std::span<Candidate> scanned = scan(view, canvas, tile_level_, sizes);
  return choose(view, scanned.first(std::min(scanned.size(), found.size())), found);
}

std::uint32_t MtcnnProposal::turns(const ImageView& view) const {
  std::uint32_t turns = 1;
  for (std::size_t level = 0; level < tile_level_; ++level) {
    turns += tiles_of(view, level).count();
  }
  return turns;
}

Tiles MtcnnProposal::tiles_of(const ImageView& view, std::size_t level) const {
  const float pixels = canvas_of(view).side / static_cast<float>(pnets_[level].input_shape().w);
  const auto side = static_cast<float>(pnets_[tile_level_].input_shape().w);
  return {view.width, view.height, side * pixels, kWindow * pixels};
}

std::size_t MtcnnProposal::choose(const ImageView& view, std::span<Candidate> scanned,
                                  std::span<Candidate> found) {
  std::size_t refined = 0;
  for (Candidate candidate : scanned) {
    if (refine(view, candidate)) {
      scanned[refined++] = candidate;
    }
  }
  const std::span<Candidate> faces =
      scanned.first(suppress_non_maxima(scanned.first(refined), kOverlapRefined));
  // Of several faces the largest comes first, unless R-Net is much less sure of it.
  std::sort(faces.begin(), faces.end(), [](const Candidate& a, const Candidate& b) {
    return a.score * a.square.side > b.score * b.square.side;
  });
  const std::size_t count = std::min(found.size(), faces.size());
  std::copy_n(faces.begin(), count, found.begin());
  return count;
}

std::span<Candidate> MtcnnProposal::scan(const ImageView& view, const Square& canvas,
                                         std::size_t first, std::size_t count) {
  std::size_t total = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    engine::Network& pnet = pnets_[i];
    if (i == first) {
      sampler_.cut_black(view, canvas, pnet.input_shape().w, pnet.input());
    } else {
      engine::Network& larger = pnets_[i - 1];
      shrink(larger.input(), larger.input_shape().w, pnet.input(), pnet.input_shape().w);
    }
    pnet.run();
    BestCandidates best(std::span<Candidate>(candidates_).subspan(total, kPerLevel));
    collect(pnet, canvas, best);
    total += suppress_non_maxima(best.kept(), kOverlapInLevel);
  }
  const std::span<Candidate> all = std::span(candidates_).first(total);
  return all.first(suppress_non_maxima(all, kOverlapOfLevels));
}

// P-Net's windows that look like faces, in pixels of the image.
void MtcnnProposal::collect(const engine::Network& pnet, const Square& canvas,
                            BestCandidates& best) const {
  const float pixels = canvas.side / static_cast<float>(pnet.input_shape().w);
  const float left = canvas.center.x - canvas.side / 2;
  const float top = canvas.center.y - canvas.side / 2;
  const engine::Shape& cells = pnet.output_shape(0);
  const float* face = pnet.output(0).data();
  const float* regression = pnet.output(1).data();
  for (std::int32_t y = 0; y < cells.h; ++y) {
    for (std::int32_t x = 0; x < cells.w; ++x, face += 8, regression += 8) {
      if (!(face[0] >= proposal_threshold_)) {
        continue;
      }
      const Square window = {{left + (kStride * static_cast<float>(x) + kWindowMiddle) * pixels,
                              top + (kStride * static_cast<float>(y) + kWindowMiddle) * pixels},
                             kWindow * pixels};
      const Square square = regressed(window, regression);
      if (is_usable(square)) {
        best.offer({square, face[0]});
      }
    }
  }
}

bool MtcnnProposal::refine(const ImageView& view, Candidate& candidate) {
  sampler_.cut_black(view, candidate.square, kRefineSide, rnet_.input());
  rnet_.run();
  const float score = rnet_.output(0)[0];
  const Square square = regressed(candidate.square, rnet_.output(1).data());
  candidate = {square, score};
  return score >= refine_threshold_ && is_usable(square);
}

}  // namespace mien::tracker
