// Where a face might be, when nothing is known.
#pragma once

#include <cstddef>
#include <span>

#include "tracker/image_view.h"
#include "tracker/squares.h"

namespace mien::tracker {

// Another detector can take the place of MTCNN by implementing this.
class FaceProposal {
 public:
  // Writes the most promising squares, best first, as many as fit into `found`; returns how many.
  // The square of a face is that of its crop: centre and side, roll ignored.
  [[nodiscard]] virtual std::size_t propose(const ImageView& view, std::span<Candidate> found) = 0;

 protected:
  ~FaceProposal() = default;
};

}  // namespace mien::tracker
