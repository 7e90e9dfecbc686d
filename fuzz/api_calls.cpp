// The bytes choose calls of the C API with valid and invalid arguments, for two trackers. Results
// are always valid, a rejected call changes nothing, and the trackers are independent.
#include <mien/mien.h>

#include <cstring>
#include <vector>

#include "fuzz/calls.h"
#include "fuzz/target.h"
#include "fuzz/views.h"

namespace {

using mien::fuzz::Bytes;
using mien::fuzz::require;

mien_result result_of(const mien_tracker* tracker) {
  mien_result result;
  mien_result_default(&result);
  require(mien_tracker_get_result(tracker, &result) == MIEN_OK);
  return result;
}

// Makes one call; returns false if the library rejects it.
bool call(Bytes& choices, mien_tracker* tracker, std::int64_t pts_ns) {
  switch (choices.between(0, 11)) {
    case 0:
    case 1:
    case 2: {
      std::vector<std::byte> memory[3];
      const mien_image image = mien::fuzz::take_image(choices, memory);
      return mien_tracker_push_video(tracker, &image, pts_ns) == MIEN_OK;
    }
    case 3:
    case 4: {
      std::vector<std::byte> memory;
      const mien_audio audio = mien::fuzz::take_audio(choices, memory);
      return (choices.coin() ? mien_tracker_push_audio(tracker, &audio, pts_ns)
                             : mien_tracker_queue_audio(tracker, &audio, pts_ns)) == MIEN_OK;
    }
    case 5:
      return mien_tracker_advance(tracker, pts_ns) == MIEN_OK;
    case 6:
      return mien_tracker_set_lod(tracker, choices.between(-1, 6)) == MIEN_OK;
    case 7:
      return mien_tracker_set_mix(tracker, choices.between(-2, MIEN_CONTROL_COUNT + 1),
                                  choices.take<float>(), choices.take<float>()) == MIEN_OK;
    case 8:
      return mien_tracker_set_audio_offset(tracker, choices.take<std::int64_t>()) == MIEN_OK;
    case 9:
      return mien_tracker_capture_neutral(tracker) == MIEN_OK;
    case 10: {
      std::byte file[MIEN_NEUTRAL_BYTES + 1];
      std::uint32_t captured = 0;
      if (mien_tracker_save_neutral(tracker, file, sizeof file, &captured) != MIEN_OK) {
        return false;
      }
      file[choices.between(0, MIEN_NEUTRAL_BYTES - 1)] ^=
          static_cast<std::byte>(choices.between(0, 255));
      return mien_tracker_load_neutral(tracker, file,
                                       static_cast<std::size_t>(choices.between(
                                           MIEN_NEUTRAL_BYTES - 1, MIEN_NEUTRAL_BYTES + 1))) ==
             MIEN_OK;
    }
    default:
      require(mien_tracker_reset(tracker) == MIEN_OK);
      return true;
  }
}

void read_face(Bytes& choices, const mien_tracker* tracker) {
  const std::int32_t faces = mien_tracker_face_count(tracker);
  require(faces >= 0 && faces <= MIEN_MAX_FACES);
  // A result with the size of another version of the header, in memory of that size.
  std::vector<std::uint64_t> memory((sizeof(mien_result) + 64) / sizeof(std::uint64_t));
  auto* result = reinterpret_cast<mien_result*>(memory.data());
  result->struct_size = static_cast<std::uint32_t>(choices.between(0, sizeof(mien_result) + 64));
  const std::int32_t index = choices.between(-1, faces);
  const mien_status status = mien_tracker_get_face(tracker, index, result);
  require(status != MIEN_OK || (index >= 0 && index < faces));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static mien_tracker* const trackers[] = {mien::fuzz::make_tracker(), mien::fuzz::make_tracker(3)};
  for (mien_tracker* tracker : trackers) {
    require(mien_tracker_reset(tracker) == MIEN_OK);
  }
  Bytes choices(data, size);
  std::int64_t pts_ns = 0;
  for (int calls = 0; calls < 24 && !choices.empty(); ++calls) {
    mien_tracker* const tracker = trackers[choices.between(0, 1)];
    mien_tracker* const other = trackers[tracker == trackers[0] ? 1 : 0];
    pts_ns = choices.between(0, 7) < 7
                 ? static_cast<std::int64_t>(static_cast<std::uint64_t>(pts_ns) + 33'333'333u)
                 : choices.take<std::int64_t>();
    const mien_result before = result_of(tracker), of_other = result_of(other);
    const bool accepted = call(choices, tracker, pts_ns);
    const mien_result after = result_of(tracker), of_other_after = result_of(other);
    mien::fuzz::require_valid(after);
    require(accepted || std::memcmp(&before, &after, sizeof before) == 0);
    require(std::memcmp(&of_other, &of_other_after, sizeof of_other) == 0);
    read_face(choices, tracker);
  }
  return 0;
}
