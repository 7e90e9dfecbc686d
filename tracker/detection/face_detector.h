// The interface of face detectors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tracker/detection/squares.h"
#include "tracker/image/image_view.h"

namespace mien::tracker {

// Implement this to replace MTCNN.
class FaceDetector {
 public:
  // Begins a scan of the whole image, which finds faces within about 30 degrees of `roll` (radians,
  // clockwise). It runs in chunks of a few million multiply-accumulates, which can be spread over
  // images of equal geometry; detections refer to the first of them. A thorough scan has more
  // detections and takes longer.
  virtual void begin(const ImageView& view, bool thorough, float roll) = 0;
  // Runs the next chunk. Returns false after the last one.
  [[nodiscard]] virtual bool run_next_chunk(const ImageView& view) = 0;
  // After the last chunk: writes the best detections to `found`, best first, and returns their
  // number. A detection's square is the face's crop before its rotation by the roll.
  [[nodiscard]] virtual std::size_t found(std::span<Detection> found) = 0;

  // A coarse search finds faces of at least a fifth of the image's longer side, within about 30
  // degrees of `roll`. It has two chunks: this one, and `end_coarse`, which refines at most as many
  // detections as fit into `found`. No other call may come between them.
  virtual void begin_coarse(const ImageView& view, float roll) = 0;
  [[nodiscard]] virtual std::size_t end_coarse(const ImageView& view,
                                               std::span<Detection> found) = 0;

  // Searches one part of the image, at a small part of the cost; allowed between the chunks of a
  // scan. Each `turn` selects another part and refines at most as many detections as fit into
  // `found`; `turns` of them in a row cover all places and sizes of upright faces.
  [[nodiscard]] virtual std::size_t detect_in_tile(const ImageView& view, std::uint32_t turn,
                                                   std::span<Detection> found) = 0;
  [[nodiscard]] virtual std::uint32_t turns(const ImageView& view) const = 0;

 protected:
  ~FaceDetector() = default;
};

}  // namespace mien::tracker
