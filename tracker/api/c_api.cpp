// C API: creation, images and results of a tracker. Validates arguments and copies results.
#include <mien/mien.h>

#include <cstdint>
#include <new>

#include "engine/arena.h"
#include "kernels/float_mode.h"
#include "tracker/api/allocate.h"
#include "tracker/api/config.h"
#include "tracker/api/report.h"
#include "tracker/api/tracker_handle.h"
#include "tracker/api/versioned_struct.h"
#include "tracker/api/weights_references.h"
#include "tracker/encoders/models.h"

namespace {

using mien::engine::Arena;
using mien::kernels::FloatMode;
using mien::tracker::allocate;
using mien::tracker::fail;
using mien::tracker::Models;
using mien::tracker::release;
using mien::tracker::report;

static_assert(MIEN_ALIGNMENT == Arena::kAlignment);
static_assert(MIEN_LANDMARK_COUNT == mien::tracker::kLandmarks);

// Takes the memory of all networks from `arena`.
mien_status load(const mien_tracker_config& config, mien_tracker& parts, Arena& arena,
                 mien_error_detail& error) {
  Models models;
  mien_status status = mien::tracker::find_models(config, error, models);
  if (status == MIEN_OK) {
    status = parts.encoders.basenet.load(models, config.cpu_mask, arena);
  }
  if (status == MIEN_OK && models.has_hifinet) {
    status = parts.encoders.hifinet.load(models, config.cpu_mask, arena);
  }
  if (status == MIEN_OK) {
    status = parts.tracker.load(models, arena);
  }
  return status == MIEN_OK ? parts.proposal.load(config, models, arena) : status;
}

// Not inlined, so that the 15 KB of its tracker leave the stack before the real one is created.
[[gnu::noinline]] mien_status measure(const mien_tracker_config& config, Arena::Need& need,
                                      mien_error_detail& error) {
  Arena arena;
  (void)arena.take(sizeof(mien_tracker));
  mien_tracker parts(config);
  const mien_status status = load(config, parts, arena, error);
  need = status == MIEN_OK ? arena.need() : Arena::Need();
  return status;
}

// Validates everything and measures the required memory.
mien_status prepare(const mien_tracker_config* given, mien_tracker_config& config,
                    Arena::Need& need, mien_error_detail& error) {
  const mien_status status = mien::tracker::read_config(given, config, error);
  return status == MIEN_OK ? measure(config, need, error) : status;
}

mien_status build(const mien_tracker_config& config, void* memory, const Arena::Need& need,
                  mien_tracker** tracker, mien_error_detail& error) {
  Arena arena(static_cast<std::byte*>(memory), need);
  auto* created = new (arena.take(sizeof(mien_tracker)).data()) mien_tracker(config);
  const mien_status status = load(config, *created, arena, error);
  if (status != MIEN_OK) {
    return status;
  }
  created->bytes = need.total_bytes();
  mien::tracker::acquire(*config.weights);
  created->tracker.reset();
  *tracker = created;
  return MIEN_OK;
}

mien_status create(const mien_tracker_config* config, mien_tracker** tracker,
                   mien_error_detail& error) {
  mien_tracker_config checked;
  Arena::Need need;
  mien_status status = prepare(config, checked, need, error);
  if (status != MIEN_OK) {
    return status;
  }
  void* memory = allocate(checked.allocator, need.total_bytes());
  if (memory == nullptr) {
    return fail(error, MIEN_ERROR_OUT_OF_MEMORY);
  }
  status = build(checked, memory, need, tracker, error);
  if (status != MIEN_OK) {
    release(checked.allocator, memory);
    return status;
  }
  (*tracker)->allocated = true;
  return MIEN_OK;
}

mien_status create_in(const mien_tracker_config* config, void* memory, std::size_t memory_bytes,
                      mien_tracker** tracker, mien_error_detail& error) {
  mien_tracker_config checked;
  Arena::Need need;
  mien_status status = mien::tracker::check_memory(memory, error);
  if (status == MIEN_OK) {
    status = prepare(config, checked, need, error);
  }
  if (status == MIEN_OK) {
    status = mien::tracker::check_size(memory_bytes, need.total_bytes(), error);
  }
  return status == MIEN_OK ? build(checked, memory, need, tracker, error) : status;
}

// Leaves no trace of a face in memory. Volatile, because a compiler may drop writes before a
// release.
void wipe(void* memory, std::size_t bytes) {
  volatile auto* byte = static_cast<volatile unsigned char*>(memory);
  for (std::size_t i = 0; i < bytes; ++i) {
    byte[i] = 0;
  }
}

const mien::tracker::Face* known_face(const mien_tracker& tracker, int32_t index) {
  return index >= 0 ? tracker.tracker.faces().known(static_cast<std::size_t>(index)) : nullptr;
}

mien_status copy_out(const mien_result& from, mien_result* to) {
  const bool written =
      mien::tracker::write_struct(from, MIEN_SIZE_THROUGH(mien_result, supported_controls), to);
  return written ? MIEN_OK : MIEN_ERROR_STRUCT_SIZE;
}

}  // namespace

mien_status mien_tracker_required_bytes(const mien_tracker_config* config, size_t* bytes,
                                        mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (bytes == nullptr) {
    return report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  const FloatMode float_mode;
  mien_tracker_config checked;
  Arena::Need need;
  const mien_status status = prepare(config, checked, need, detail);
  *bytes = need.total_bytes();
  return report(status, detail, error);
}

mien_status mien_tracker_create(const mien_tracker_config* config, mien_tracker** tracker,
                                mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (tracker == nullptr) {
    return report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  *tracker = nullptr;
  const FloatMode float_mode;
  return report(create(config, tracker, detail), detail, error);
}

mien_status mien_tracker_create_in(const mien_tracker_config* config, void* memory,
                                   size_t memory_bytes, mien_tracker** tracker,
                                   mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (tracker == nullptr) {
    return report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  *tracker = nullptr;
  const FloatMode float_mode;
  return report(create_in(config, memory, memory_bytes, tracker, detail), detail, error);
}

void mien_tracker_destroy(mien_tracker* tracker) {
  if (tracker == nullptr) {
    return;
  }
  const mien_allocator allocator = tracker->allocator;
  const bool allocated = tracker->allocated;
  const std::size_t bytes = tracker->bytes;
  const mien_weights& weights = *tracker->weights;
  tracker->~mien_tracker();
  wipe(tracker, bytes);
  if (allocated) {
    release(allocator, tracker);
  }
  mien::tracker::release(weights);
}

mien_status mien_tracker_reset(mien_tracker* tracker) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const FloatMode float_mode;
  tracker->tracker.reset();
  return MIEN_OK;
}

mien_status mien_tracker_set_lod(mien_tracker* tracker, int32_t lod) {
  if (tracker == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  return tracker->tracker.set_level(lod) ? MIEN_OK : MIEN_ERROR_UNSUPPORTED_LOD;
}

mien_status mien_tracker_push_video(mien_tracker* tracker, const mien_image* image,
                                    int64_t pts_ns) {
  const FloatMode float_mode;
  return tracker != nullptr ? tracker->tracker.push(image, pts_ns) : MIEN_ERROR_NULL_ARGUMENT;
}

mien_status mien_tracker_get_result(const mien_tracker* tracker, mien_result* result) {
  if (tracker == nullptr || result == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  return copy_out(tracker->tracker.result(), result);
}

int32_t mien_tracker_face_count(const mien_tracker* tracker) {
  int32_t count = 0;
  while (tracker != nullptr && known_face(*tracker, count) != nullptr) {
    ++count;
  }
  return count;
}

mien_status mien_tracker_get_face(const mien_tracker* tracker, int32_t index, mien_result* result) {
  if (tracker == nullptr || result == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien::tracker::Face* face = known_face(*tracker, index);
  return face != nullptr ? copy_out(face->result(), result) : MIEN_ERROR_OUT_OF_RANGE;
}

void mien_result_default(mien_result* result) {
  if (result != nullptr) {
    *result = {};
    result->struct_size = sizeof *result;
  }
}
