// C API: weights.
#include <mien/mien.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>

#include "formats/bundle.h"
#include "formats/packed_file.h"
#include "tracker/api/allocate.h"
#include "tracker/api/report.h"
#include "tracker/api/versioned_struct.h"
#include "tracker/api/weights_references.h"
#include "tracker/encoders/weights.h"

namespace {

using mien::tracker::fail;

static_assert(MIEN_MAX_NAME_BYTES == mien::formats::kMaxNameBytes);
static_assert(MIEN_MAX_NAME_BYTES == mien::formats::kMaxKeyBytes);
static_assert(MIEN_ALIGNMENT == mien::formats::kFileAlignment);
static_assert(std::is_trivially_destructible_v<mien_weights>, "release only frees the memory");

// A weight file in the caller's memory.
struct Part {
  std::span<const std::byte> bytes;
  std::int32_t index = -1;   // in mien_weights_config.files
  std::uint64_t offset = 0;  // in that file, bytes
  bool packed = false;
  bool in_place = false;
  std::size_t copy_bytes = 0;  // size of the copied or unpacked file
};

struct Parts {
  std::size_t count = 0;
  std::array<Part, mien_weights::kMaxModels> all;
};

// Locates an error within a file of a bundle.
mien_status located(const Part& part, mien_error_detail& error) {
  error.file = part.index;
  if ((error.known & MIEN_DETAIL_OFFSET) != 0) {
    error.offset += part.offset;
  }
  return static_cast<mien_status>(error.status);
}

mien_status measure(const mien_weights_config& config, Part& part, mien_error_detail& error) {
  part.packed = mien::formats::is_packed(part.bytes);
  if (part.packed) {
    return mien::formats::unpacked_bytes(part.bytes, part.copy_bytes, error) == MIEN_OK
               ? MIEN_OK
               : located(part, error);
  }
  const bool aligned = reinterpret_cast<std::uintptr_t>(part.bytes.data()) % MIEN_ALIGNMENT == 0;
  part.in_place = config.copy == 0 && aligned;
  part.copy_bytes = part.in_place ? 0 : part.bytes.size();
  return MIEN_OK;
}

mien_status add(const mien_weights_config& config, const Part& part, Parts& parts,
                mien_error_detail& error) {
  if (part.offset > 0 && !mien::formats::is_weight_file(part.bytes)) {
    fail(error, MIEN_ERROR_WEIGHTS_TRAILING_BYTES, "file");
    mien::formats::set_offset(error, 0);
    return located(part, error);
  }
  if (parts.count == parts.all.size()) {
    fail(error, MIEN_ERROR_WEIGHTS_LIMIT, "files");
    return located(part, error);
  }
  Part& added = parts.all[parts.count++] = part;
  return measure(config, added, error);
}

// Lists the files of all bundles.
mien_status list_parts(const mien_weights_config& config, Parts& parts, mien_error_detail& error) {
  for (std::int32_t i = 0; i < MIEN_MAX_WEIGHT_FILES; ++i) {
    std::span<const std::byte> rest(static_cast<const std::byte*>(config.files[i]),
                                    config.file_bytes[i]);
    std::uint64_t offset = 0;
    bool more = rest.data() != nullptr;  // also opens an empty file, which is an error
    while (more) {
      const std::size_t bytes = mien::formats::first_file_bytes(rest);
      const mien_status status =
          add(config, {.bytes = rest.first(bytes), .index = i, .offset = offset}, parts, error);
      if (status != MIEN_OK) {
        return status;
      }
      rest = rest.subspan(bytes);
      offset += bytes;
      more = !rest.empty();
    }
  }
  return parts.count > 0 ? MIEN_OK : fail(error, MIEN_ERROR_NULL_ARGUMENT, "files");
}

constexpr std::uint64_t aligned(std::uint64_t bytes) {
  return (bytes + MIEN_ALIGNMENT - 1) / MIEN_ALIGNMENT * MIEN_ALIGNMENT;
}

std::uint64_t required_bytes(const Parts& parts) {
  std::uint64_t bytes = aligned(sizeof(mien_weights));
  for (std::size_t i = 0; i < parts.count; ++i) {
    bytes += aligned(parts.all[i].copy_bytes);
  }
  return bytes;
}

// `copy`: memory for part.copy_bytes.
mien_status open(const Part& part, std::byte* copy, mien_weights::File& file,
                 mien_error_detail& error) {
  std::span<const std::byte> bytes = part.bytes;
  if (part.packed) {
    if (mien::formats::unpack(part.bytes, {copy, part.copy_bytes}, error) != MIEN_OK) {
      return located(part, error);
    }
    bytes = {copy, part.copy_bytes};
  } else if (!part.in_place) {
    std::memcpy(copy, part.bytes.data(), part.bytes.size());
    bytes = {copy, part.copy_bytes};
  }
  file.index = part.index;
  file.offset = part.offset;
  const mien_error_detail opened = file.model.open(bytes);
  if (opened.status == MIEN_OK) {
    return MIEN_OK;
  }
  error = opened;
  return located({.bytes = {}, .index = part.index, .offset = part.packed ? 0 : part.offset},
                 error);
}

mien_status create(const mien_weights_config* given, mien_weights** weights,
                   mien_error_detail& error) {
  if (given == nullptr) {
    return fail(error, MIEN_ERROR_NULL_ARGUMENT, "config");
  }
  mien_weights_config config;
  mien_weights_config_default(&config);
  if (!mien::tracker::read_struct(*given, MIEN_SIZE_THROUGH(mien_weights_config, file_bytes),
                                  config)) {
    return fail(error, MIEN_ERROR_STRUCT_SIZE, "struct_size");
  }
  if (!mien::tracker::is_valid(config.allocator)) {
    return fail(error, MIEN_ERROR_OUT_OF_RANGE, "allocator");
  }
  Parts parts;
  mien_status status = list_parts(config, parts, error);
  if (status != MIEN_OK) {
    return status;
  }
  const std::uint64_t bytes = required_bytes(parts);
  auto* memory = bytes <= SIZE_MAX / 2 ? static_cast<std::byte*>(mien::tracker::allocate(
                                             config.allocator, static_cast<std::size_t>(bytes)))
                                       : nullptr;
  if (memory == nullptr) {
    return fail(error, MIEN_ERROR_OUT_OF_MEMORY);
  }
  auto* created = new (memory) mien_weights;
  created->allocator = config.allocator;
  std::byte* copy = memory + aligned(sizeof(mien_weights));
  for (std::size_t i = 0; status == MIEN_OK && i < parts.count; ++i) {
    status = open(parts.all[i], copy, created->files[created->count++], error);
    copy += aligned(parts.all[i].copy_bytes);
  }
  if (status != MIEN_OK) {
    mien::tracker::release(config.allocator, memory);
    return status;
  }
  *weights = created;
  return MIEN_OK;
}

}  // namespace

namespace mien::tracker {

void acquire(const mien_weights& weights) {
  weights.references.fetch_add(1, std::memory_order_relaxed);
}

void release(const mien_weights& weights) {
  if (weights.references.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    const mien_allocator allocator = weights.allocator;
    release(allocator, const_cast<mien_weights*>(&weights));
  }
}

}  // namespace mien::tracker

void mien_weights_config_default(mien_weights_config* config) {
  if (config != nullptr) {
    *config = {};
    config->struct_size = sizeof *config;
  }
}

mien_status mien_weights_create(const mien_weights_config* config, mien_weights** weights,
                                mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (weights == nullptr) {
    return mien::tracker::report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  *weights = nullptr;
  return mien::tracker::report(create(config, weights, detail), detail, error);
}

void mien_weights_destroy(mien_weights* weights) {
  if (weights != nullptr) {
    mien::tracker::release(*weights);
  }
}
