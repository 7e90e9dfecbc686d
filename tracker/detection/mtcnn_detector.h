// Face proposal by the first two stages of MTCNN: Zhang et al. 2016, "Joint Face Detection and
// Alignment using Multitask Cascaded Convolutional Networks".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/arena.h"
#include "engine/network.h"
#include "tracker/detection/face_detector.h"
#include "tracker/detection/tiles.h"
#include "tracker/encoders/models.h"
#include "tracker/image/sampler.h"

namespace mien::tracker {

// The image, in the middle of a black square, is seen at sizes that shrink by 0.709 down to P-Net's
// window. P-Net finds candidates on each, R-Net looks at the best of them again.
class MtcnnDetector final : public FaceDetector {
 public:
  // Takes from `arena` what the networks need; only measures when the arena does.
  [[nodiscard]] mien_status load(const mien_tracker_config& config, const Models& models,
                                 engine::Arena& arena);

  // Shares: the image of one of the larger sizes; P-Net on a band of it, or on all smaller sizes;
  // R-Net on some of the candidates.
  void begin(const ImageView& view, bool thorough, float roll) override;
  [[nodiscard]] bool go_on(const ImageView& view) override;
  [[nodiscard]] std::size_t found(std::span<Detection> found) override;

  // Shares: P-Net on the largest of the smaller sizes; P-Net on the others and R-Net.
  void begin_coarse(const ImageView& view, float roll) override;
  [[nodiscard]] std::size_t end_coarse(const ImageView& view, std::span<Detection> found) override;

  // The larger sizes of the pyramid are searched in tiles, one a turn, the smaller ones together.
  [[nodiscard]] std::size_t detect_in_tile(const ImageView& view, std::uint32_t turn,
                                           std::span<Detection> found) override;
  [[nodiscard]] std::uint32_t turns(const ImageView& view) const override;

 private:
  static constexpr std::size_t kMaxLarge = 7;  // 640 * 0.709^7 < 60
  static constexpr std::size_t kMaxSmall = 5;  // 60 * 0.709^5 < 12
  static constexpr std::size_t kPerSize = 64;  // candidates kept
  static constexpr std::size_t kRefined = 64;  // candidates shown to R-Net

  // One of the larger sizes of the pyramid.
  struct LargeSize {
    std::span<float> picture;  // [side][side][3]
    engine::Network band;      // P-Net on as many of its rows as one share allows
    std::int32_t side = 0;
    std::int32_t cell_rows = 0;  // of P-Net's windows on all of it
  };

  // Where a search is.
  struct Search {
    Crop canvas;
    float threshold = 1.0f;      // of P-Net
    std::size_t size = 0;        // of the pyramid, that P-Net looks at next
    bool has_picture = false;    // of that size
    std::int32_t cell_row = 0;   // of it, that P-Net looks at next
    std::int32_t end_row = 0;    // of it, after the last that can show a face
    std::size_t scanned = 0;     // candidates of P-Net
    std::size_t seen_again = 0;  // of these, by R-Net
    std::size_t refined = 0;     // of these, kept
    std::span<Detection> detections;
  };

  [[nodiscard]] mien_status load_large(const mien_tracker_config& config,
                                       const engine::Model& model, std::int32_t side,
                                       engine::Arena& arena);
  [[nodiscard]] Tiles tiles_of(const ImageView& view, const LargeSize& size) const;
  void make_picture(const ImageView& view);
  // Limits the search of a size to the rows of P-Net's windows whose middles lie in the image.
  void choose_rows(const ImageView& view, const LargeSize& size);
  void scan_band();
  // Those from `first` on; the very first has its image.
  void scan_small_sizes(Search& search, std::size_t first, std::size_t end);
  // Fills the square input of the network with the crop.
  void cut(const ImageView& view, const Crop& crop, engine::Network& network) const;
  // Fills the input of the largest of the small sizes.
  void make_small_picture(const ImageView& view);
  [[nodiscard]] Search part(const Crop& canvas);
  void scan(Search& search, engine::Network& pnet);
  [[nodiscard]] std::size_t finish(Search& search, const ImageView& view,
                                   std::span<Detection> found);
  // Of one size of the pyramid, the candidates so far.
  [[nodiscard]] static BestDetections none_yet(const Search& search);
  static void keep(Search& search, const BestDetections& best);
  // P-Net's windows that look like faces, from row `first` of its output on, which is row `at` of
  // the windows of all of the canvas, seen at `side` pixels.
  static void collect(const Search& search, const engine::Network& pnet, std::int32_t side,
                      std::int32_t first, std::int32_t at, BestDetections& best);
  // Candidates of different sizes for one face become one.
  static void end_scan(Search& search, std::size_t count);
  void refine(Search& search, const ImageView& view, std::size_t count);
  [[nodiscard]] bool refine(const Crop& canvas, const ImageView& view, Detection& detection);
  [[nodiscard]] static std::size_t found(const Search& search, std::span<Detection> found);

  Sampler sampler_;
  std::span<float> row_;  // scratch, of the largest size
  float proposal_threshold_ = 0.0f;
  float refine_threshold_ = 0.0f;
  std::array<LargeSize, kMaxLarge> large_;
  std::size_t large_count_ = 0;
  std::array<engine::Network, kMaxSmall> small_;  // P-Net on each of the sizes of a tile and below
  std::size_t small_count_ = 0;
  engine::Network rnet_;
  Search search_;  // of the whole image
  Search coarse_;
  BestDetections best_{{}};              // of the size that P-Net is looking at
  std::span<Detection> detections_;      // of the search of the whole image, in the arena
  std::span<Detection> few_detections_;  // of the other searches, in the arena
};

}  // namespace mien::tracker
