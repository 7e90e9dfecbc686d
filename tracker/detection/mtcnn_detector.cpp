// Runs P-Net over an image pyramid and R-Net on its candidates.
#include "tracker/detection/mtcnn_detector.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracker/detection/tiles.h"
#include "tracker/image/shrink.h"

namespace mien::tracker {
namespace {

constexpr float kPyramidFactor = 0.709f;
constexpr std::int32_t kWindow = 12;   // side of P-Net's window, pixels
constexpr float kStride = 2.0f;        // of P-Net's windows, pixels
constexpr float kWindowMiddle = 6.0f;  // centre of a window, pixels from its start
constexpr std::int32_t kRefineSide = 24;
constexpr float kOverlapInSize = 0.5f;
constexpr float kOverlapOfSizes = 0.7f;
constexpr float kOverlapRefined = 0.4f;
constexpr float kThorough = 0.25f;  // factor on P-Net's threshold in a thorough scan
constexpr float kMaxLogStep = 1.0f;
constexpr std::int32_t kMaxTile = 60;  // pixels
// Sizes of a chunk: about ten million multiply-accumulates for each network.
constexpr std::int32_t kChunkPixels = 6400;  // of a band for P-Net
constexpr std::int32_t kMinRows = 24;        // minimum rows of a band
constexpr std::size_t kRefinedPerChunk = 5;  // by R-Net

// Applies the regression (dx, dy, dlog), relative to the side of the window.
Square regressed(const Square& window, const float* regression) {
  const float dlog = std::clamp(regression[2], -kMaxLogStep, kMaxLogStep);
  return {{window.center.x + regression[0] * window.side,
           window.center.y + regression[1] * window.side},
          window.side * std::exp(dlog)};
}

bool is_usable(const Square& square) {
  return is_finite(square.center) && std::isfinite(square.side) && square.side > 0.0f;
}

template <class T>
std::span<T> take(engine::Arena& arena, std::size_t count) {
  const std::span<std::byte> memory = arena.take(count * sizeof(T));
  return {reinterpret_cast<T*>(memory.data()), memory.size() / sizeof(T)};
}

struct Extent {
  float width;
  float height;
};

// Extent of the region along axes rotated by `roll`.
Extent extent(const Rect& region, float roll) {
  const float c = std::abs(std::cos(roll)), s = std::abs(std::sin(roll));
  return {c * region.width + s * region.height, s * region.width + c * region.height};
}

// The square around the region, rotated by `roll`.
Crop canvas_of(const ImageView& view, float roll) {
  const Extent turned = extent(view.region, roll);
  return {view.region.center(), std::max(turned.width, turned.height), roll};
}

// Converts from canvas to image coordinates.
Crop to_image(const Crop& canvas, const Square& square) {
  if (canvas.roll == 0.0f) {
    return {square.center, square.side, 0.0f};
  }
  const float c = std::cos(canvas.roll), s = std::sin(canvas.roll);
  const float x = square.center.x - canvas.center.x, y = square.center.y - canvas.center.y;
  return {
      {canvas.center.x + c * x - s * y, canvas.center.y + s * x + c * y}, square.side, canvas.roll};
}

}  // namespace

mien_status MtcnnDetector::load(const mien_tracker_config& config, const Models& models,
                                engine::Arena& arena) {
  if (!sampler_.init(config.cpu_mask, arena)) {
    return MIEN_ERROR_UNSUPPORTED_CPU;
  }
  proposal_threshold_ = config.proposal_threshold;
  refine_threshold_ = config.refine_threshold;
  detections_ = take<Detection>(arena, (kMaxLarge + kMaxSmall) * kPerSize);
  few_detections_ = take<Detection>(arena, kMaxSmall * kPerSize);
  row_ = take<float>(arena, 3 * static_cast<std::size_t>(config.proposal_size));
  const engine::Model& model = models.proposal;
  mien_status status = MIEN_OK;
  large_count_ = small_count_ = 0;
  auto size = static_cast<float>(config.proposal_size);
  for (; status == MIEN_OK; size *= kPyramidFactor) {
    const auto side = static_cast<std::int32_t>(std::lround(size));
    if (side < kWindow) {
      break;
    }
    status = side > kMaxTile ? load_large(config, model, side, arena)
                             : small_[small_count_++].load(model, {"pnet", {side, side, 3}, {1, 3}},
                                                           config.cpu_mask, arena);
  }
  const engine::NetworkForm rnet = {"rnet", {kRefineSide, kRefineSide, 3}, {1, 3}};
  return status == MIEN_OK ? rnet_.load(model, rnet, config.cpu_mask, arena) : status;
}

mien_status MtcnnDetector::load_large(const mien_tracker_config& config, const engine::Model& model,
                                      std::int32_t side, engine::Arena& arena) {
  LargeSize& size = large_[large_count_++];
  const auto floats = 3 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  size.side = side;
  size.pixels = take<float>(arena, floats);
  // Windows lie two rows apart, so every band begins at an even one.
  const std::int32_t rows = std::min(std::max(kChunkPixels / side, kMinRows), side) / 2 * 2;
  const mien_status status =
      size.band.load(model, {"pnet", {rows, side, 3}, {1, 3}}, config.cpu_mask, arena);
  if (status == MIEN_OK && !arena.measuring()) {
    size.window_rows = size.band.output_shape(0).h + (side - rows) / 2;
  }
  return status;
}

void MtcnnDetector::begin(const ImageView& view, bool thorough, float roll) {
  search_ = {};
  search_.canvas = canvas_of(view, roll);
  search_.threshold = proposal_threshold_ * (thorough ? kThorough : 1.0f);
  search_.detections = detections_;
}

bool MtcnnDetector::run_next_chunk(const ImageView& view) {
  if (search_.size < large_count_) {
    if (search_.is_resampled) {
      scan_band();
    } else {
      resample_to_large(view);
    }
    return true;
  }
  if (search_.size == large_count_) {
    ++search_.size;
    resample_to_small(view);
    scan_small_sizes(search_, 0, small_count_);
    end_scan(search_, kRefined);
  } else {
    refine(search_, view, kRefinedPerChunk);
  }
  return search_.next_to_refine < search_.scanned;
}

void MtcnnDetector::fill_input(const ImageView& view, const Crop& crop,
                               engine::Network& network) const {
  sampler_.warp_with_black_border(view, crop, network.input_shape().w, network.input());
}

void MtcnnDetector::resample_to_small(const ImageView& view) {
  engine::Network& first = small_.front();
  if (large_count_ == 0) {
    fill_input(view, search_.canvas, first);
  } else {
    const LargeSize& last = large_[large_count_ - 1];
    shrink(last.pixels, last.side, first.input(), first.input_shape().w, row_);
  }
}

std::size_t MtcnnDetector::detect_in_tile(const ImageView& view, std::uint32_t turn,
                                          std::span<Detection> detections) {
  for (std::size_t i = 0; i < large_count_; ++i) {
    const Tiles tiles = tiles_of(view, large_[i]);
    if (turn < tiles.count()) {
      const Square tile = tiles.square(turn);
      Search search = begin_part({tile.center, tile.side, 0.0f});
      fill_input(view, search.canvas, small_.front());
      scan_small_sizes(search, 0, 1);
      return finish(search, view, detections);
    }
    turn -= tiles.count();
  }
  begin_coarse(view, 0.0f);
  return end_coarse(view, detections);
}

// A rotated square of this side does not cover the corners of the image; no large face fits there.
void MtcnnDetector::begin_coarse(const ImageView& view, float roll) {
  coarse_ = begin_part({view.region.center(), view.region.longer_side(), roll});
  fill_input(view, coarse_.canvas, small_.front());
  scan_small_sizes(coarse_, 0, 1);
}

std::size_t MtcnnDetector::end_coarse(const ImageView& view, std::span<Detection> detections) {
  scan_small_sizes(coarse_, 1, small_count_);
  return finish(coarse_, view, detections);
}

MtcnnDetector::Search MtcnnDetector::begin_part(const Crop& canvas) {
  Search search;
  search.canvas = canvas;
  search.threshold = proposal_threshold_;
  search.detections = few_detections_;
  return search;
}

std::size_t MtcnnDetector::finish(Search& search, const ImageView& view,
                                  std::span<Detection> detections) {
  end_scan(search, detections.size());
  refine(search, view, detections.size());
  return found(search, detections);
}

std::uint32_t MtcnnDetector::turns(const ImageView& view) const {
  return std::accumulate(large_.begin(), large_.begin() + static_cast<std::ptrdiff_t>(large_count_),
                         1u, [&](std::uint32_t turns, const LargeSize& size) {
                           return turns + tiles_of(view, size).count();
                         });
}

Tiles MtcnnDetector::tiles_of(const ImageView& view, const LargeSize& size) const {
  const float pixels = canvas_of(view, 0.0f).side / static_cast<float>(size.side);
  const auto side = static_cast<float>(small_.front().input_shape().w);
  return {view.region, side * pixels, kWindow * pixels};
}

std::size_t MtcnnDetector::found(std::span<Detection> detections) {
  return found(search_, detections);
}

std::size_t MtcnnDetector::found(const Search& search, std::span<Detection> found) {
  const std::span<Detection> refined = search.detections.first(search.refined);
  const std::span<Detection> faces = refined.first(suppress_non_maxima(refined, kOverlapRefined));
  // The largest face comes first, unless its detector score is much lower.
  std::sort(faces.begin(), faces.end(), [](const Detection& a, const Detection& b) {
    return a.score * a.square.side > b.score * b.square.side;
  });
  const std::size_t count = std::min(found.size(), faces.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Crop crop = to_image(search.canvas, faces[i].square);
    found[i] = {{crop.center, crop.side}, faces[i].score, crop.roll};
  }
  return count;
}

void MtcnnDetector::resample_to_large(const ImageView& view) {
  const LargeSize& size = large_[search_.size];
  if (search_.size == 0) {
    sampler_.warp_with_black_border(view, search_.canvas, size.side, size.pixels);
  } else {
    const LargeSize& larger = large_[search_.size - 1];
    shrink(larger.pixels, larger.side, size.pixels, size.side, row_);
  }
  search_.is_resampled = true;
  best_ = empty_list(search_);
  choose_rows(view, size);
}

void MtcnnDetector::choose_rows(const ImageView& view, const LargeSize& size) {
  const Crop& canvas = search_.canvas;
  const float height = extent(view.region, canvas.roll).height;
  const float scale = static_cast<float>(size.side) / canvas.side;
  const float above = (canvas.side - height) / 2 * scale;  // of the image, in pixels of this size
  const auto before = static_cast<std::int32_t>(std::ceil((above - kWindowMiddle) / kStride));
  const std::int32_t outside = std::max(before, 0);
  search_.window_row = std::min(outside, size.window_rows - 1);
  search_.end_row = std::max(size.window_rows - outside, search_.window_row + 1);
}

void MtcnnDetector::scan_band() {
  LargeSize& size = large_[search_.size];
  const std::int32_t rows = size.band.output_shape(0).h;
  const std::int32_t first = std::min(search_.window_row, size.window_rows - rows);
  const std::size_t offset =  // P-Net has a cell every 2 pixels, of 3 values
      6 * static_cast<std::size_t>(first) * static_cast<std::size_t>(size.side);
  const std::span<float> input = size.band.input();
  std::copy_n(size.pixels.subspan(offset, input.size()).begin(), input.size(), input.begin());
  size.band.run();
  collect(search_, size.band, size.side, search_.window_row - first, search_.window_row, best_);
  search_.window_row = first + rows;
  if (search_.window_row >= search_.end_row) {
    append(search_, best_);
    ++search_.size;
    search_.is_resampled = false;
  }
}

void MtcnnDetector::scan_small_sizes(Search& search, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    engine::Network& pnet = small_[i];
    const std::int32_t side = pnet.input_shape().w;
    if (i > 0) {
      engine::Network& larger = small_[i - 1];
      shrink(larger.input(), larger.input_shape().w, pnet.input(), side, row_);
    }
    scan(search, pnet);
  }
}

void MtcnnDetector::scan(Search& search, engine::Network& pnet) {
  pnet.run();
  BestDetections best = empty_list(search);
  collect(search, pnet, pnet.input_shape().w, 0, 0, best);
  append(search, best);
}

BestDetections MtcnnDetector::empty_list(const Search& search) {
  return BestDetections(search.detections.subspan(search.scanned, kPerSize));
}

void MtcnnDetector::append(Search& search, const BestDetections& best) {
  search.scanned += suppress_non_maxima(best.kept(), kOverlapInSize);
}

void MtcnnDetector::end_scan(Search& search, std::size_t count) {
  const std::span<Detection> all = search.detections.first(search.scanned);
  search.scanned = std::min(suppress_non_maxima(all, kOverlapOfSizes), count);
}

void MtcnnDetector::collect(const Search& search, const engine::Network& pnet, std::int32_t side,
                            std::int32_t first, std::int32_t at, BestDetections& best) {
  const Crop& canvas = search.canvas;
  const float pixels = canvas.side / static_cast<float>(side);
  const float left = canvas.center.x - canvas.side / 2;
  const float top = canvas.center.y - canvas.side / 2;
  const engine::Shape& cells = pnet.output_shape(0);
  const std::size_t skipped =
      8 * static_cast<std::size_t>(first) * static_cast<std::size_t>(cells.w);
  const float* face = pnet.output(0).data() + skipped;
  const float* regression = pnet.output(1).data() + skipped;
  for (std::int32_t y = at; y < at + cells.h - first; ++y) {
    for (std::int32_t x = 0; x < cells.w; ++x, face += 8, regression += 8) {
      if (!(face[0] >= search.threshold)) {
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

void MtcnnDetector::refine(Search& search, const ImageView& view, std::size_t count) {
  for (; count > 0 && search.next_to_refine < search.scanned; --count, ++search.next_to_refine) {
    Detection detection = search.detections[search.next_to_refine];
    if (refine(search.canvas, view, detection)) {
      search.detections[search.refined++] = detection;
    }
  }
}

bool MtcnnDetector::refine(const Crop& canvas, const ImageView& view, Detection& detection) {
  fill_input(view, to_image(canvas, detection.square), rnet_);
  rnet_.run();
  const float score = rnet_.output(0)[0];
  const Square square = regressed(detection.square, rnet_.output(1).data());
  detection = {square, score};
  return score >= refine_threshold_ && is_usable(square);
}

}  // namespace mien::tracker
