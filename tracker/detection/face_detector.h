// Where a face might be, when nothing is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tracker/detection/squares.h"
#include "tracker/image/image_view.h"

namespace mien::tracker {

// Another detector can take the place of MTCNN by implementing this.
class FaceDetector {
 public:
  // A search of the whole image runs in shares of a few million multiply-accumulates, so that it
  // can be spread over images of one geometry; a face is where the first of them shows it. A
  // thorough search proposes more and takes longer. It finds faces within some 30 degrees of `roll`
  // (radians clockwise).
  virtual void begin(const ImageView& view, bool thorough, float roll) = 0;
  // Runs the next share. Returns false after the last.
  [[nodiscard]] virtual bool go_on(const ImageView& view) = 0;
  // After the last share: writes the most promising squares, best first, as many as fit into
  // `found`; returns their number. The square of a face is that of its crop: centre and side, roll
  // ignored.
  [[nodiscard]] virtual std::size_t found(std::span<Detection> found) = 0;

  // A coarse search finds faces that take at least a fifth of the image's longer side, within some
  // 30 degrees of `roll`. It has two shares: this one, and `end_coarse`, which refines no more
  // detections than fit into `found`. Other calls may come before and after both, but not between.
  virtual void begin_coarse(const ImageView& view, float roll) = 0;
  [[nodiscard]] virtual std::size_t end_coarse(const ImageView& view,
                                               std::span<Detection> found) = 0;

  // Searches a part of the image, at a small part of the cost, also between the shares of a search.
  // Every `turn` takes another part and refines no more detections than fit into `found`; `turns`
  // of them in a row cover all places and sizes of upright faces.
  [[nodiscard]] virtual std::size_t detect_in_tile(const ImageView& view, std::uint32_t turn,
                                                   std::span<Detection> found) = 0;
  [[nodiscard]] virtual std::uint32_t turns(const ImageView& view) const = 0;

 protected:
  ~FaceDetector() = default;
};

}  // namespace mien::tracker
