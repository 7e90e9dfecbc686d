// Follows one face through a video: frames in, animation out.
#pragma once

#include <mien/mien.h>

#include <array>
#include <cstdint>

#include "tracker/basenet.h"
#include "tracker/image_view.h"
#include "tracker/proposal.h"
#include "tracker/stage_timer.h"
#include "tracker/timeline.h"

namespace mien::tracker {

// Searching: the proposal looks at the whole image, BaseNet judges what it proposes and turns the
// crop upright. Tracking: the landmarks of one frame place the crop of the next. Level of detail 1:
// on every other frame the encoder rests, and the decoders get the features of the frame before
// again.
class Tracker {
 public:
  // Both networks must outlive the tracker. `reset` comes before the first image.
  Tracker(const mien_tracker_config& config, BaseNet& basenet, FaceProposal& proposal);

  [[nodiscard]] mien_status push(const mien_image* image, std::int64_t pts_ns);
  [[nodiscard]] const mien_result& result() const { return state_.result; }
  void reset();

 private:
  // Everything that the images so far have left behind, but for the state of the decoders.
  struct State {
    Timeline timeline;
    ImageGeometry geometry;  // of the image before
    bool following = false;  // `crop` and `sight` are a face
    bool encoder_rests = false;
    std::int32_t misses = 0;         // judged frames in a row without the face
    std::int32_t search_frames = 0;  // frames in a row with nothing found
    Crop crop;                       // where to look next
    Sight sight;                     // the last time the face was seen
    HeadPose pose;
    mien_result result = {};
  };

  void follow(const ImageView& view, bool cut);
  void search(const ImageView& view);
  [[nodiscard]] bool search_is_due() const;
  [[nodiscard]] bool acquire(const ImageView& view, const Square& square);
  [[nodiscard]] bool look(const ImageView& view, const Crop& crop, Sight& sight);
  [[nodiscard]] bool accept(const ImageView& view, const Sight& sight);
  void animate(const ImageView& view);
  void fade(float seconds);
  void publish(const ImageView& view, std::int64_t pts_ns);
  void publish_face(const ImageView& view);

  const mien_tracker_config config_;
  BaseNet& basenet_;
  FaceProposal& proposal_;
  StageTimer timer_;
  State state_;
};

}  // namespace mien::tracker
