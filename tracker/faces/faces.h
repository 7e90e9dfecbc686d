// The faces of one tracker and their identities.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "tracker/faces/face.h"

namespace mien::tracker {

class Faces {
 public:
  // Allocates config.max_faces faces from `arena`, or only measures if the arena does. `config` and
  // `encoders` must outlive this object.
  [[nodiscard]] mien_status load(const mien_tracker_config& config, Encoders& encoders,
                                 const Models& models, engine::Arena& arena);

  [[nodiscard]] std::span<Face> all() { return faces_; }
  [[nodiscard]] std::span<const Face> all() const { return faces_; }
  [[nodiscard]] std::size_t tracked() const;
  [[nodiscard]] bool has_free_slot() const { return tracked() < faces_.size(); }

  // The known face with the n-th lowest id; nullptr if there are fewer.
  [[nodiscard]] const Face* known(std::size_t n) const;

  // The known face with the lowest id, or a free one.
  [[nodiscard]] const Face& first() const {
    const Face* longest_known = known(0);
    return longest_known != nullptr ? *longest_known : faces_.front();
  }
  [[nodiscard]] Face& first() { return const_cast<Face&>(std::as_const(*this).first()); }

  void reset(std::int32_t level);

  // Whether a tracked face is at this place.
  [[nodiscard]] bool is_taken(const Square& square) const;

  // Verifies a detection and starts to track it if it is a new face; keeps its id if it was lost at
  // this place recently. Requires has_free_slot(). `alignments`: see Face::find.
  [[nodiscard]] bool add_face(Frame& frame, const Detection& detection, int alignments);

  // Resets tracked faces at the place of one with a lower id.
  void drop_duplicates(std::int32_t level);
  // Resets faces that were lost for a long time, except the last one.
  void forget_lost(std::int32_t level);

 private:
  [[nodiscard]] Face& slot_for(const Square& square);

  std::span<Face> faces_;
  std::uint32_t newest_id_ = 0;
};

}  // namespace mien::tracker
