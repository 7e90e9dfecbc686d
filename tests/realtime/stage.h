// Calls every function that may be called between create and destroy, for about a minute of input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace mien::tests {

// Allocates everything before the first frame.
class Stage {
 public:
  explicit Stage(std::int32_t max_faces)
      : tracker_({},
                 [=](mien_tracker_config& config) {
                   config.max_faces = max_faces;
                   config.audio_queue_samples = 8192;
                 }),
        single_face_(max_faces == 1) {
    for (const auto format : {MIEN_IMAGE_NV12, MIEN_IMAGE_RGB, MIEN_IMAGE_I420}) {
      buffers_.emplace_back(disc_picture(160.0f, 120.0f, 70.0f), Layout{.format = format});
      buffers_.emplace_back(Picture(320, 240), Layout{.format = format});
      buffers_.emplace_back(disc_picture(90.0f, 50.0f, 40.0f, 160, 90),
                            Layout{.format = format, .rotation = 90});
    }
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      samples_[i] = static_cast<float>(i * 7919 % 1000) / 500.0f - 1.0f;
    }
  }

  // Returns whether all calls succeeded.
  bool play() {
    constexpr std::int32_t kRates[] = {48000, 44100, 16000, 8000, 192000};
    mien_tracker* const tracker = tracker_.tracker().get();
    mien_audio audio;
    mien_audio_default(&audio);
    audio.samples[0] = samples_.data();
    mien_result result;
    mien_result_default(&result);
    std::array<std::byte, MIEN_NEUTRAL_BYTES> neutral{};
    std::array<float, MIEN_CONTROL_COUNT> values{};  // the size of the MediaPipe vocabulary
    bool accepted = true;
    const auto check = [&](mien_status status) { accepted = accepted && status == MIEN_OK; };
    std::uint64_t faces = 0;
    for (int i = 0; i < 600; ++i) {
      const std::int64_t pts_ns = i * kFrameNs;
      audio.sample_rate = kRates[static_cast<std::size_t>(i / 50) % std::size(kRates)];
      audio.frames = static_cast<std::size_t>(1 + i * 37 % 4000);
      // Half of the time as from a microphone's own thread.
      check(i / 75 % 2 == 0 ? mien_tracker_push_audio(tracker, &audio, pts_ns)
                            : mien_tracker_queue_audio(tracker, &audio, pts_ns));
      const std::size_t scene = static_cast<std::size_t>(i / 40) % buffers_.size();
      check(i % 9 == 5 ? mien_tracker_advance(tracker, pts_ns)
                       : mien_tracker_push_video(tracker, &buffers_[scene].image(), pts_ns));
      check(mien_tracker_get_result(tracker, &result));
      for (std::int32_t face = 0; face < mien_tracker_face_count(tracker); ++face) {
        check(mien_tracker_get_face(tracker, face, &result));
        ++faces;
        check(mien_vocabulary_values(MIEN_VOCABULARY_MEDIAPIPE, result.controls, values.data(),
                                     static_cast<std::int32_t>(values.size())));
      }
      check(mien_tracker_set_lod(tracker, i / 20 % 5));
      check(mien_tracker_set_mix(tracker, i % MIEN_CONTROL_COUNT, 0.5f, 0.5f));
      check(mien_tracker_set_audio_offset(tracker, i));
      if (i % 150 == 149) {
        check(mien_tracker_reset(tracker));
      }
      if (single_face_) {
        check(mien_tracker_capture_neutral(tracker));
        check(mien_tracker_save_neutral(tracker, neutral.data(), neutral.size(), nullptr));
        check(mien_tracker_load_neutral(tracker, neutral.data(), neutral.size()));
      }
    }
    return accepted && faces > 100;
  }

 private:
  BlobTracker tracker_;
  const bool single_face_;
  std::vector<Buffer> buffers_;
  std::array<float, 4096> samples_{};
};

}  // namespace mien::tests
