// Tracks up to max_faces faces: assigns detections to them and adds and removes faces.
#include "tracker/faces/faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>

namespace mien::tracker {
namespace {

// Maximum distance between the centres of two squares around the same face, relative to the larger
// side; for a face that may have moved while it was lost.
constexpr float kSamePlace = 0.4f;
constexpr float kNear = 1.0f;

float distance(const Square& a, const Square& b) {
  return std::hypot(a.center.x - b.center.x, a.center.y - b.center.y) / std::max(a.side, b.side);
}

bool was_lost_here(const Face& face, const Square& square) {
  return face.is_known() && !face.is_tracked() && face.seconds_lost() < Face::kRememberedSeconds &&
         distance(face.square(), square) < kNear;
}

}  // namespace

mien_status Faces::load(const mien_tracker_config& config, Encoders& encoders, const Models& models,
                        engine::Arena& arena) {
  static_assert(std::is_trivially_destructible_v<Face>, "the arena does not call destructors");
  static_assert(alignof(Face) <= engine::Arena::kAlignment && sizeof(Face) % alignof(Face) == 0);
  const auto count = static_cast<std::size_t>(config.max_faces);
  const std::span<std::byte> memory = arena.take(count * sizeof(Face));
  mien_status status = MIEN_OK;
  for (std::size_t i = 0; status == MIEN_OK && i < count; ++i) {
    if (arena.measuring()) {
      Decoders measured;  // a Face would need more stack
      status = measured.load(models, config.cpu_mask, arena);
    } else {
      status = (new (memory.data() + i * sizeof(Face)) Face(config, encoders))->load(models, arena);
    }
  }
  faces_ = {reinterpret_cast<Face*>(memory.data()), arena.measuring() ? 0 : count};
  return status;
}

std::size_t Faces::tracked() const {
  return static_cast<std::size_t>(std::count_if(
      faces_.begin(), faces_.end(), [](const Face& face) { return face.is_tracked(); }));
}

const Face* Faces::known(std::size_t n) const {
  const Face* found = nullptr;
  for (const Face& face : faces_) {
    const auto is_before = [&](const Face& other) {
      return other.is_known() && other.id() < face.id();
    };
    if (face.is_known() &&
        static_cast<std::size_t>(std::count_if(faces_.begin(), faces_.end(), is_before)) == n) {
      found = &face;
    }
  }
  return found;
}

void Faces::reset(std::int32_t level) {
  newest_id_ = 0;
  for (Face& face : faces_) {
    face.reset(level);
  }
}

bool Faces::is_taken(const Square& square) const {
  return std::any_of(faces_.begin(), faces_.end(), [&](const Face& face) {
    return face.is_tracked() && distance(face.square(), square) < kSamePlace;
  });
}

bool Faces::add_face(Frame& frame, const Detection& detection, int alignments) {
  const Square& square = detection.square;
  if (is_taken(square)) {
    return false;
  }
  Face& face = slot_for(square);
  Encoding encoding;
  if (!face.find(frame, detection, alignments, encoding) ||
      is_taken({encoding.crop.center, encoding.crop.side})) {
    return false;
  }
  const std::uint32_t id = was_lost_here(face, square) ? face.id() : newest_id_ + 1;
  if (!face.start_tracking(frame, encoding, id)) {
    return false;
  }
  newest_id_ = std::max(newest_id_, id);
  return true;
}

// The slot of a face that was lost here, a free one, or that of the face lost for the longest time.
Face& Faces::slot_for(const Square& square) {
  const auto priority = [&](const Face& face) {
    if (face.is_tracked()) {
      return -1.0f;
    }
    if (was_lost_here(face, square)) {
      return std::numeric_limits<float>::infinity();
    }
    return face.is_known() ? face.seconds_lost() : std::numeric_limits<float>::max();
  };
  return *std::max_element(faces_.begin(), faces_.end(),
                           [&](const Face& a, const Face& b) { return priority(a) < priority(b); });
}

void Faces::drop_duplicates(std::int32_t level) {
  for (Face& younger : faces_) {
    const bool is_duplicate =
        younger.is_tracked() && std::any_of(faces_.begin(), faces_.end(), [&](const Face& older) {
          return older.is_tracked() && older.id() < younger.id() &&
                 distance(older.square(), younger.square()) < kSamePlace;
        });
    if (is_duplicate) {
      younger.reset(level);
    }
  }
}

void Faces::forget_lost(std::int32_t level) {
  for (Face& face : faces_) {
    const bool is_last = known(1) == nullptr;
    if (!is_last && face.is_known() && !face.is_tracked() &&
        face.seconds_lost() > Face::kRememberedSeconds) {
      face.reset(level);
    }
  }
}

}  // namespace mien::tracker
