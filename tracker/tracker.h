// Finds and follows a face through a video: frames in, animation out.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "tracker/face.h"
#include "tracker/image_view.h"
#include "tracker/levels.h"
#include "tracker/proposal.h"
#include "tracker/stage_timer.h"
#include "tracker/timeline.h"

namespace mien::tracker {

// Searching: the proposal looks at the whole image, BaseNet judges what it proposes and turns the
// crop upright. Tracking: the landmarks of one frame place the crop of the next.
class Tracker {
 public:
  // Both must outlive the tracker. `reset` comes before the first image.
  Tracker(const mien_tracker_config& config, Encoders& encoders, FaceProposal& proposal);

  // Takes from `arena` what the faces need; only measures when the arena does.
  [[nodiscard]] mien_status load(const Models& models, Arena& arena) {
    return face_.load(models, arena);
  }

  [[nodiscard]] mien_status push(const mien_image* image, std::int64_t pts_ns);
  [[nodiscard]] const mien_result& result() const { return state_.result; }
  void reset();

  // 0 = automatic. False if there are no weights for it.
  [[nodiscard]] bool set_level(std::int32_t lod);

 private:
  // Everything that the images so far have left behind, but for the face.
  struct State {
    Timeline timeline;
    ImageGeometry geometry;          // of the image before
    std::int32_t search_frames = 0;  // frames in a row with nothing found
    mien_result result = {};
  };

  [[nodiscard]] std::int32_t level() const { return lod_ == 0 ? governor_.level() : lod_; }
  void search(Frame& frame);
  [[nodiscard]] bool search_is_due() const;
  void publish(const Frame& frame, std::int64_t pts_ns);

  const mien_tracker_config config_;
  FaceProposal& proposal_;
  StageTimer timer_;
  std::int32_t lod_;
  LevelGovernor governor_;
  Face face_;
  State state_;
};

}  // namespace mien::tracker
