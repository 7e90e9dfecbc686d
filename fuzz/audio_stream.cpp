// Audio in one block and the same audio in parts of any size give the same results, bit for bit.
// Results are finite for any samples and timestamps.
#include <mien/mien.h>

#include <cstring>
#include <vector>

#include "fuzz/calls.h"
#include "fuzz/target.h"
#include "fuzz/views.h"

namespace {

mien_result animate(mien_tracker* tracker, std::int64_t pts_ns) {
  mien_result result;
  mien_result_default(&result);
  mien::fuzz::require(mien_tracker_advance(tracker, pts_ns) == MIEN_OK);
  mien::fuzz::require(mien_tracker_get_result(tracker, &result) == MIEN_OK);
  mien::fuzz::require_valid(result);
  return result;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mien::fuzz;
  static mien_tracker* const whole = make_tracker();
  static mien_tracker* const parts = make_tracker();
  require(mien_tracker_reset(whole) == MIEN_OK && mien_tracker_reset(parts) == MIEN_OK);
  Bytes choices(data, size);
  std::int64_t pts_ns = choices.coin() ? choices.between(0, 1000) : choices.take<std::int64_t>();
  for (int block = 0; block < 8 && !choices.empty(); ++block) {
    std::vector<std::byte> memory;
    mien_audio audio = take_audio(choices, memory);
    const mien_status status = mien_tracker_push_audio(whole, &audio, pts_ns);
    if (status != MIEN_OK) {
      require(mien_tracker_push_audio(parts, &audio, pts_ns) == status);
      continue;
    }
    const std::size_t frames = audio.frames;
    const std::size_t bytes = (audio.format == MIEN_SAMPLES_INT16 ? 2u : 4u) *
                              (audio.planar != 0 ? 1u : static_cast<std::size_t>(audio.channels));
    for (std::size_t done = 0; done < frames;) {
      mien_audio part = audio;
      part.frames = std::min(frames - done, static_cast<std::size_t>(choices.between(1, 400)));
      for (int i = 0; i < audio.channels; ++i) {
        part.samples[i] = static_cast<const std::byte*>(audio.samples[i]) + done * bytes;
      }
      // The exact time of the part's first sample.
      const auto later = static_cast<std::uint64_t>(done) * 1'000'000'000u /
                         static_cast<std::uint64_t>(audio.sample_rate);
      const auto at = static_cast<std::int64_t>(static_cast<std::uint64_t>(pts_ns) + later);
      require(mien_tracker_push_audio(parts, &part, at) == MIEN_OK);
      done += part.frames;
    }
    const auto length = static_cast<std::uint64_t>(frames) * 1'000'000'000u /
                        static_cast<std::uint64_t>(audio.sample_rate);
    const mien_result a = animate(whole, pts_ns), b = animate(parts, pts_ns);
    (void)b;
    require(std::memcmp(&a, &b, sizeof a) == 0);
    pts_ns = static_cast<std::int64_t>(static_cast<std::uint64_t>(pts_ns) + length);
    if (choices.between(0, 3) == 3) {  // a gap, a step back, or another stream
      pts_ns = static_cast<std::int64_t>(
          static_cast<std::uint64_t>(pts_ns) +
          static_cast<std::uint64_t>(choices.one_of<std::int64_t>(
              {30'000'000, -30'000'000, 700'000'000, -5'000'000'000, INT64_MAX})));
    }
  }
  return 0;
}
