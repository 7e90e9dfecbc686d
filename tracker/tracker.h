// Tracks faces through a video: images and audio in, animation out.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>

#include "tracker/audio/audio_track.h"
#include "tracker/detection/face_detector.h"
#include "tracker/encoders/levels.h"
#include "tracker/faces/faces.h"
#include "tracker/image/image_view.h"
#include "tracker/stage_timer.h"
#include "tracker/timeline.h"

namespace mien::tracker {

// Searching: the detector scans the whole image; BaseNet verifies its detections and aligns the
// crop. Tracking: the landmarks of one frame place the crop of the next. While more faces are
// allowed, detection runs in one tile of every image.
class Tracker {
 public:
  // `encoders` and `proposal` must outlive the tracker. Call `reset` before the first image.
  Tracker(const mien_tracker_config& config, Encoders& encoders, FaceDetector& proposal);

  // Allocates faces and audio track from `arena`, or only measures if the arena does.
  [[nodiscard]] mien_status load(const Models& models, engine::Arena& arena);

  [[nodiscard]] mien_status push(const mien_image* image, std::int64_t pts_ns);
  // Creates a frame of output without an image.
  void advance(std::int64_t pts_ns);
  [[nodiscard]] mien_status push_audio(const mien_audio* sound, std::int64_t pts_ns);
  // nullptr if audio is disabled.
  [[nodiscard]] AudioTrack* voice() { return audio_; }
  [[nodiscard]] const Faces& faces() const { return faces_; }
  // The result of the known face with the lowest id; its status is SEARCHING without a face.
  [[nodiscard]] const mien_result& result() const { return faces_.first().result(); }
  void reset();

  // Starts a capture at the current level with the next frame. Requires max_faces = 1.
  void capture_neutral() { faces_.all().front().neutral(level()).capture(); }
  [[nodiscard]] Neutral& neutral(std::int32_t level) { return faces_.all().front().neutral(level); }
  [[nodiscard]] const Neutral& neutral(std::int32_t level) const {
    return faces_.all().front().neutral(level);
  }

  // 0 = automatic. False if the weights for the level are missing.
  [[nodiscard]] bool set_level(std::int32_t lod);

 private:
  // Maximum number of detections of a scan that BaseNet verifies.
  static constexpr std::size_t kMaxVerified = MIEN_MAX_FACES + 2;

  // Without a face, every image runs some steps: chunks of a scan of the whole image, and coarse
  // searches in between. Detections are verified before other steps.
  struct Search {
    bool is_scanning = false;  // a scan of the whole image is running
    std::uint32_t step = 0;    // next step
    std::array<Detection, kMaxVerified> detected;
    std::size_t count = 0;
    std::size_t verified = 0;

    [[nodiscard]] bool has_unverified() const { return verified < count; }
    [[nodiscard]] bool is_running() const { return is_scanning || step > 0 || has_unverified(); }
  };

  // State between frames, except that of the faces.
  struct State {
    Timeline timeline;
    ImageView view;  // previous image; its pixels are no longer valid
    Search search;
    bool cut_without_image = false;        // discontinuity since the previous image
    std::int32_t frames_without_face = 0;  // consecutive frames without a face
    std::uint32_t searches = 0;            // scans since the last face
    std::uint32_t turn = 0;                // calls of detect_in_tile
    std::uint32_t coarse_searches = 0;     // since the last face
    // Totals.
    std::uint64_t frames = 0;
    std::uint64_t face_frames = 0;
    std::uint64_t proposal_runs = 0;
    std::uint64_t encoder_runs = 0;
  };

  [[nodiscard]] std::int32_t level() const { return lod_ == 0 ? governor_.level() : lod_; }
  void track(Frame& frame);
  // Runs the steps of one frame.
  void search(Frame& frame);
  void search_step(Frame& frame);
  // Runs whole scans at all rolls on one frame, until a face is found.
  void search_all_rolls(Frame& frame);
  void begin_scan(Frame& frame, bool thorough, float roll);
  // Runs the next chunk. Returns false after the last one.
  bool scan(Frame& frame);
  void begin_coarse(Frame& frame);
  void end_coarse(Frame& frame);
  // Roll of the next scan or coarse search, radians.
  [[nodiscard]] float next_roll() const;
  [[nodiscard]] float next_coarse_roll() const;
  // Roll of the lost face; 0 if it was almost upright.
  [[nodiscard]] float lost_roll() const;
  void verify_next(Frame& frame, int alignments);
  // Counts frames without a face. True if detection runs on this one.
  [[nodiscard]] bool detection_is_due();
  void detect_in_tile(Frame& frame);
  // Ends a frame: computes the output of all faces and audio.
  void finish(Frame& frame, std::int64_t pts_ns, std::uint32_t flags);
  void publish(const Frame& frame, std::int64_t pts_ns, std::uint32_t flags);
  void describe(const Frame& frame, std::int64_t pts_ns, std::uint32_t flags,
                mien_result& result) const;
  void mix_voice();

  const mien_tracker_config config_;
  Encoders& encoders_;
  FaceDetector& proposal_;
  StageTimer timer_;
  std::int32_t lod_;
  LevelGovernor governor_;
  Faces faces_;
  AudioTrack* audio_ = nullptr;  // in the arena
  State state_;
};

}  // namespace mien::tracker
