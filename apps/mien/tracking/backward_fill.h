// Fills frames without a face by tracking backward from the frame on which the face is detected.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mien/mien.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/mien/tracking/audio_mix.h"
#include "apps/mien/tracking/held_image.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {

// While a face is missing, frames wait here until one is detected. A second tracker then runs over
// them in reverse order, and its results replace the rows without that face. Rows with a face never
// change. Frames leave in order.
class BackwardFill {
 public:
  using Sink =
      std::function<void(std::int64_t number, const mien_image* image, std::span<const Result>)>;

  // Frames wait no longer than this.
  static constexpr std::int64_t kMaxHeldNs = 3'000'000'000;
  static constexpr std::size_t kMaxHeldBytes = std::size_t{512} << 20;

  // `tracker`: options of the tracker whose results are added. `neutral`: the path of a neutral
  // file, or empty; it must outlive this.
  BackwardFill(const LoadedTracker::Options& tracker, const std::string& neutral, Sink sink);

  void add(std::int64_t number, const mien_image& image, std::vector<Result> faces);
  // All frames leave.
  void finish();

  // Frames that have a face by tracking backward only.
  [[nodiscard]] std::uint64_t filled() const { return filled_; }

 private:
  using Controls = std::array<float, MIEN_CONTROL_COUNT>;

  struct Row {
    std::int64_t number;
    HeldImage image;
    std::vector<Result> faces;
    bool is_final = false;  // nothing can fill it
  };

  // A face was detected after frames without it.
  struct Detection {
    std::uint32_t face_id;
    std::int64_t number;  // of the frame
  };

  [[nodiscard]] bool is_complete(std::span<const Result> faces) const;
  void note_detections();
  // Whether enough frames have followed, or the face was lost again.
  [[nodiscard]] bool is_due(const Detection& detection) const;
  void fill_before(const Detection& detection);
  // Results of one face in the rows before `first`, from the last of them on, by tracking backward
  // from row `last`.
  [[nodiscard]] std::vector<Result> track_backward(std::uint32_t face_id, std::size_t first,
                                                   std::size_t last);
  [[nodiscard]] std::vector<Result> faces_on(const Row& row, std::int64_t pts_ns);
  void start_tracker(std::int32_t lod);
  void fill(std::size_t row, std::uint32_t face_id, const Result& found);
  // The controls that fade out of the face that was lost before a row.
  [[nodiscard]] Controls fading(std::size_t row) const;
  [[nodiscard]] std::size_t row_of(std::int64_t number) const;
  void release();
  void release_first();

  LoadedTracker::Options options_;
  bool mixes_audio_;
  const std::string& neutral_;
  AudioMix mix_;  // loaded with the tracker
  Sink sink_;
  std::optional<LoadedTracker> tracker_;  // created when first needed
  std::deque<Row> rows_;
  std::size_t held_bytes_ = 0;
  std::vector<Detection> detections_;
  std::optional<Result> lost_;  // the latest tracked face that has left
  std::uint64_t filled_ = 0;
};

}  // namespace mien::app
