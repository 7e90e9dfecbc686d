// Face detection by the first two stages of MTCNN: Zhang et al. 2016, "Joint Face Detection and
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

// Runs P-Net on a pyramid of the image, centred in a black square, whose sizes shrink by 0.709 down
// to P-Net's window, and R-Net on the best detections of each size.
class MtcnnDetector final : public FaceDetector {
 public:
  // Allocates the networks from `arena`, or only measures if the arena does.
  [[nodiscard]] mien_status load(const mien_tracker_config& config, const Models& models,
                                 engine::Arena& arena);

  // Chunks of a scan: resampling the image to one of the larger sizes; P-Net on a band of it, or on
  // all smaller sizes; R-Net on some of the detections.
  void begin(const ImageView& view, bool thorough, float roll) override;
  [[nodiscard]] bool run_next_chunk(const ImageView& view) override;
  [[nodiscard]] std::size_t found(std::span<Detection> found) override;

  // Chunks: P-Net on the largest of the smaller sizes; P-Net on the others, and R-Net.
  void begin_coarse(const ImageView& view, float roll) override;
  [[nodiscard]] std::size_t end_coarse(const ImageView& view, std::span<Detection> found) override;

  // Each turn covers one tile of one of the larger sizes of the pyramid, or all smaller sizes.
  [[nodiscard]] std::size_t detect_in_tile(const ImageView& view, std::uint32_t turn,
                                           std::span<Detection> found) override;
  [[nodiscard]] std::uint32_t turns(const ImageView& view) const override;

 private:
  static constexpr std::size_t kMaxLarge = 7;  // 640 * 0.709^7 < 60
  static constexpr std::size_t kMaxSmall = 5;  // 60 * 0.709^5 < 12
  static constexpr std::size_t kPerSize = 64;  // maximum detections of P-Net
  static constexpr std::size_t kRefined = 64;  // maximum detections that R-Net refines

  // One of the larger sizes of the pyramid.
  struct LargeSize {
    std::span<float> pixels;  // [side][side][3]
    engine::Network band;     // P-Net on the rows of one chunk
    std::int32_t side = 0;
    std::int32_t window_rows = 0;  // rows of P-Net's windows
  };

  // The progress of a scan.
  struct Search {
    Crop canvas;
    float threshold = 1.0f;       // of P-Net
    std::size_t size = 0;         // next size of the pyramid
    bool is_resampled = false;    // the image to that size
    std::int32_t window_row = 0;  // next row of P-Net's windows
    std::int32_t end_row = 0;     // after the last row that can show a face
    std::size_t scanned = 0;      // detections of P-Net
    std::size_t next_to_refine = 0;
    std::size_t refined = 0;  // detections accepted by R-Net
    std::span<Detection> detections;
  };

  [[nodiscard]] mien_status load_large(const mien_tracker_config& config,
                                       const engine::Model& model, std::int32_t side,
                                       engine::Arena& arena);
  [[nodiscard]] Tiles tiles_of(const ImageView& view, const LargeSize& size) const;
  void resample_to_large(const ImageView& view);
  // Limits a size to the rows of P-Net's windows whose centres lie in the image.
  void choose_rows(const ImageView& view, const LargeSize& size);
  void scan_band();
  // Runs P-Net on the small sizes from `first` on. The input of the largest must be filled.
  void scan_small_sizes(Search& search, std::size_t first, std::size_t end);
  // Fills the square input of the network with the crop.
  void fill_input(const ImageView& view, const Crop& crop, engine::Network& network) const;
  // Fills the input of the largest small size.
  void resample_to_small(const ImageView& view);
  [[nodiscard]] Search begin_part(const Crop& canvas);
  void scan(Search& search, engine::Network& pnet);
  [[nodiscard]] std::size_t finish(Search& search, const ImageView& view,
                                   std::span<Detection> found);
  // An empty list for the detections of one size of the pyramid.
  [[nodiscard]] static BestDetections empty_list(const Search& search);
  static void append(Search& search, const BestDetections& best);
  // Collects detections from P-Net's output, from row `first` on, which is row `at` of the windows
  // of the whole canvas at `side` pixels.
  static void collect(const Search& search, const engine::Network& pnet, std::int32_t side,
                      std::int32_t first, std::int32_t at, BestDetections& best);
  // Merges detections of one face at different sizes.
  static void end_scan(Search& search, std::size_t count);
  void refine(Search& search, const ImageView& view, std::size_t count);
  [[nodiscard]] bool refine(const Crop& canvas, const ImageView& view, Detection& detection);
  [[nodiscard]] static std::size_t found(const Search& search, std::span<Detection> found);

  Sampler sampler_;
  std::span<float> row_;  // scratch for a row of the largest size
  float proposal_threshold_ = 0.0f;
  float refine_threshold_ = 0.0f;
  std::array<LargeSize, kMaxLarge> large_;
  std::size_t large_count_ = 0;
  std::array<engine::Network, kMaxSmall> small_;  // P-Net on the sizes of a tile and below
  std::size_t small_count_ = 0;
  engine::Network rnet_;
  Search search_;
  Search coarse_;
  BestDetections best_{{}};              // of the current size
  std::span<Detection> detections_;      // of a scan, in the arena
  std::span<Detection> few_detections_;  // of coarse searches and tiles, in the arena
};

}  // namespace mien::tracker
