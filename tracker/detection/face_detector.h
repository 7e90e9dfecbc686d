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
  // A search of the whole image is done in shares, each a few million multiply-accumulates, so that
  // it can be spread over images. They must be of one geometry; a face is where the first one
  // has it. A thorough one proposes more and takes longer. Faces within some 30 degrees of `roll`
  // (radians clockwise) are found.
  virtual void begin(const ImageView& view, bool thorough, float roll) = 0;
  // The next share. False: it was the last.
  [[nodiscard]] virtual bool go_on(const ImageView& view) = 0;
  // After the last: writes the most promising squares, best first, as many as fit into `found`;
  // returns how many. The square of a face is that of its crop: centre and side, roll ignored.
  [[nodiscard]] virtual std::size_t found(std::span<Detection> found) = 0;

  // The same for a part of the image, at a small part of the cost, also between the shares of a
  // search. Every `turn` takes another part and refines no more detections than fit into `found`;
  // `turns` of them in a row cover all places and sizes.
  [[nodiscard]] virtual std::size_t detect_in_tile(const ImageView& view, std::uint32_t turn,
                                                   std::span<Detection> found) = 0;
  // The same for faces that take at least a seventh of the image's longer side, at any place,
  // turned by `roll` (radians clockwise).
  [[nodiscard]] virtual std::size_t detect_large(const ImageView& view, float roll,
                                                 std::span<Detection> found) = 0;
  [[nodiscard]] virtual std::uint32_t turns(const ImageView& view) const = 0;

 protected:
  ~FaceDetector() = default;
};

}  // namespace mien::tracker
