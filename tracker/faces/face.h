// One face: followed from frame to frame, animated over time.
#pragma once

#include <mien/mien.h>

#include <cstdint>

#include "tracker/decoders/decoders.h"
#include "tracker/detection/squares.h"
#include "tracker/encoders/basenet.h"
#include "tracker/encoders/hifinet.h"
#include "tracker/image/image_view.h"
#include "tracker/stage_timer.h"

namespace mien::tracker {

// What the faces of a tracker share.
struct Encoders {
  BaseNet basenet;
  HiFiNet hifinet;  // only if there are weights for it
};

// One image, and what happens on it.
struct Frame {
  const ImageView& view;
  StageTimer& timer;
  std::int32_t level;  // of detail
  float seconds;       // since the frame before
  bool cut;            // the film was cut before it
  std::uint64_t encoder_runs = 0;
};

// What is told about a face on one frame.
struct FaceOutput {
  std::array<float, kControls> controls = {};
  Landmarks landmarks = {};
  HeadPose pose;
};

class Face {
 public:
  // After it was lost: its id waits for it, and its controls have faded.
  static constexpr float kRememberedSeconds = 2.0f;

  // Both must outlive the face.
  Face(const mien_tracker_config& config, Encoders& encoders)
      : config_(config), encoders_(encoders) {}

  // The temporal decoders.
  [[nodiscard]] mien_status load(const Models& models, engine::Arena& arena) {
    return decoders_.load(models, config_.cpu_mask, arena);
  }

  [[nodiscard]] std::uint32_t id() const { return state_.id; }
  [[nodiscard]] bool is_tracked() const { return state_.tracked; }
  // It is followed, or was once.
  [[nodiscard]] bool is_known() const { return state_.status != MIEN_FACE_SEARCHING; }
  // Since it was followed last.
  [[nodiscard]] float seconds_lost() const { return state_.seconds_lost; }
  // Where it is, or was last.
  [[nodiscard]] Square square() const { return {state_.crop.center, state_.crop.side}; }
  // Of its crop, radians clockwise.
  [[nodiscard]] float roll() const { return state_.crop.roll; }
  [[nodiscard]] Neutral& neutral(std::int32_t level) { return decoders_.neutral(level); }
  [[nodiscard]] const Neutral& neutral(std::int32_t level) const {
    return decoders_.neutral(level);
  }
  // Bit i: control i is driven, at this level or by what still fades out of another.
  [[nodiscard]] std::uint64_t supported_controls(std::int32_t level) const {
    const bool shows = is_known() && seconds_lost() < kRememberedSeconds;
    return decoders_.supported_controls(level) | (shows ? decoders_.active_controls() : 0);
  }

  // Forgets everything.
  void reset(std::int32_t level);
  // Pixels mean other places than before: it is followed no more, and what is known of its place
  // is brought over.
  void change_geometry(const ImageGeometry& before, const ImageGeometry& now);
  // The decoders begin anew: the film was cut.
  void cut(std::int32_t level) { decoders_.reset(level); }

  // Whether the candidate is a face, judged after so many alignments of the crop to its landmarks;
  // if so, what is seen of it, and where.
  [[nodiscard]] bool find(Frame& frame, const Detection& detection, int alignments,
                          Encoding& encoding);
  // Follows from now on the face that was found. False if it cannot be.
  [[nodiscard]] bool start_tracking(Frame& frame, const Encoding& encoding, std::uint32_t id);
  // Nothing in the image looks like a face.
  void mark_absent() { state_.face_probability = 0.0f; }

  // Looks for it where it was.
  void track(Frame& frame);
  // It was not seen on this frame.
  void mark_missed(const Frame& frame);
  // How much the picture says of each control, 0..1: the face comes and goes within a few frames.
  [[nodiscard]] std::array<float, kControls> video_weights() const;
  // One frame of output: controls move on if it is followed, and fade if not.
  void animate(Frame& frame);

  // Fills in what is the face's own. Once per frame.
  void publish(const Frame& frame);
  [[nodiscard]] const mien_result& result() const { return result_; }
  [[nodiscard]] mien_result& result() { return result_; }

 private:
  struct State {
    std::uint32_t id = 0;
    bool tracked = false;               // `crop` and `sight` are a face
    bool alternate = false;             // the next frame is one on which encoders may rest
    bool has_hifinet_features = false;  // HiFiNet did, since the level was 1
    std::int32_t misses = 0;            // judged frames in a row without the face
    Crop crop;                          // where to look next
    Encoding encoding;                  // the last time the face was seen
    Features close = {};                // HiFiNet's, of the last time that it looked
    Landmarks refinement = {};  // of BaseNet's landmarks by HiFiNet's then, in sides of the crop
    FaceOutput seen;
    FaceOutput shown;    // smoothed
    bool is_new = true;  // nothing to smooth with yet
    mien_face_status status = MIEN_FACE_SEARCHING;
    float seconds_lost = 0.0f;
    float presence = 0.0f;
    float face_probability = 0.0f;  // of the crop judged last
    std::uint32_t flags = 0;        // MIEN_RESULT_* of this frame
  };

  [[nodiscard]] bool encode(Frame& frame, const Crop& crop, Encoding& encoding);
  [[nodiscard]] bool accept(const Frame& frame, const Encoding& encoding);
  void encode_hifinet(Frame& frame);
  [[nodiscard]] Landmarks landmarks(std::int32_t level) const;
  void show(float seconds);
  void fade(float seconds);

  const mien_tracker_config& config_;
  Encoders& encoders_;
  Decoders decoders_;
  State state_;
  mien_result result_ = {};
};

}  // namespace mien::tracker
