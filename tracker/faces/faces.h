// The faces of one tracker: who is who.
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
  // Takes from `arena` config.max_faces of them; only measures when the arena does. `config` and
  // `encoders` must outlive them.
  [[nodiscard]] mien_status load(const mien_tracker_config& config, Encoders& encoders,
                                 const Models& models, engine::Arena& arena);

  [[nodiscard]] std::span<Face> all() { return faces_; }
  [[nodiscard]] std::span<const Face> all() const { return faces_; }
  [[nodiscard]] std::size_t tracked() const;
  [[nodiscard]] bool has_free_slot() const { return tracked() < faces_.size(); }

  // The known one with the n-th lowest id; nullptr: there are not so many.
  [[nodiscard]] const Face* known(std::size_t n) const;

  // That one, or one that is free.
  [[nodiscard]] const Face& first() const {
    const Face* longest_known = known(0);
    return longest_known != nullptr ? *longest_known : faces_.front();
  }
  [[nodiscard]] Face& first() { return const_cast<Face&>(std::as_const(*this).first()); }

  void reset(std::int32_t level);

  // Whether a face that is followed is here.
  [[nodiscard]] bool is_taken(const Square& square) const;

  // Whether the candidate is a face that nobody follows yet; if so it is followed from now on,
  // under its old id if it was lost here lately. Only while there is room. `alignments`: of the
  // crop to its landmarks, before it is judged.
  [[nodiscard]] bool add_face(Frame& frame, const Detection& detection, int alignments);

  // Of faces followed at the same place only the one known longest stays.
  void drop_duplicates(std::int32_t level);
  // Those lost for long, but for the last of all.
  void forget_lost(std::int32_t level);

 private:
  [[nodiscard]] Face& place_for(const Square& square);

  std::span<Face> faces_;
  std::uint32_t newest_id_ = 0;
};

}  // namespace mien::tracker
