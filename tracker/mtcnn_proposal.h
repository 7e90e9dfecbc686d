// Face proposal by the first two stages of MTCNN: Zhang et al. 2016, "Joint Face Detection and
// Alignment using Multitask Cascaded Convolutional Networks".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/arena.h"
#include "engine/network.h"
#include "tracker/models.h"
#include "tracker/proposal.h"
#include "tracker/sampler.h"
#include "tracker/tiles.h"

namespace mien::tracker {

// The image, in the middle of a black square, is seen at sizes that shrink by 0.709 down to P-Net's
// window. P-Net finds candidates on each, R-Net looks at the best of them again.
class MtcnnProposal final : public FaceProposal {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const mien_tracker_config& config, const Models& models,
                                 engine::Arena& arena);

  [[nodiscard]] std::size_t propose(const ImageView& view, std::span<Candidate> found) override;

  // The larger sizes of the pyramid are looked at in tiles, one a turn, the smaller ones together.
  [[nodiscard]] std::size_t glance(const ImageView& view, std::uint32_t turn,
                                   std::span<Candidate> found) override;
  [[nodiscard]] std::uint32_t turns(const ImageView& view) const override;

 private:
  static constexpr std::size_t kMaxLevels = 12;  // 640 * 0.709^12 < 12
  static constexpr std::size_t kPerLevel = 64;   // candidates kept
  static constexpr std::size_t kRefined = 64;    // candidates shown to R-Net

  // P-Net's candidates on `count` sizes of `canvas`, from the one of level `first` on.
  [[nodiscard]] std::span<Candidate> scan(const ImageView& view, const Square& canvas,
                                          std::size_t first, std::size_t count);
  // R-Net's choice among the best of them, written to `found`.
  [[nodiscard]] std::size_t choose(const ImageView& view, std::span<Candidate> scanned,
                                   std::span<Candidate> found);
  [[nodiscard]] Tiles tiles_of(const ImageView& view, std::size_t level) const;
  void collect(const engine::Network& pnet, const Square& canvas, BestCandidates& best) const;
  [[nodiscard]] bool refine(const ImageView& view, Candidate& candidate);

  Sampler sampler_;
  float proposal_threshold_ = 0.0f;
  float refine_threshold_ = 0.0f;
  std::array<engine::Network, kMaxLevels> pnets_;  // the same weights for the sizes of the pyramid
  std::size_t levels_ = 0;
  std::size_t tile_level_ = 0;  // whose size is that of a tile
  engine::Network rnet_;
  std::array<Candidate, kMaxLevels* kPerLevel> candidates_ = {};
};

}  // namespace mien::tracker
