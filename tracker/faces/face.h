// One face: tracked from frame to frame, and animated over time.
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

// The encoders, shared by all faces of a tracker.
struct Encoders {
  BaseNet basenet;
  HiFiNet hifinet;  // only if its weights are given
};

// One image and its properties.
struct Frame {
  const ImageView& view;
  StageTimer& timer;
  std::int32_t level;  // of detail
  float seconds;       // since the previous frame
  bool cut;            // a discontinuity precedes it
  std::uint64_t encoder_runs = 0;
};

// The output for a face on one frame.
struct FaceOutput {
  std::array<float, kControls> controls = {};
  Landmarks landmarks = {};
  HeadPose pose;
};

class Face {
 public:
  // For this time after a loss the face keeps its id; then its controls have faded.
  static constexpr float kRememberedSeconds = 2.0f;

  // Both must outlive the face.
  Face(const mien_tracker_config& config, Encoders& encoders)
      : config_(config), encoders_(encoders) {}

  // Loads the temporal decoders.
  [[nodiscard]] mien_status load(const Models& models, engine::Arena& arena) {
    return decoders_.load(models, config_.cpu_mask, arena);
  }

  [[nodiscard]] std::uint32_t id() const { return state_.id; }
  [[nodiscard]] bool is_tracked() const { return state_.tracked; }
  // Whether it is tracked, or was lost and not replaced.
  [[nodiscard]] bool is_known() const { return state_.status != MIEN_FACE_SEARCHING; }
  // Time since it was last tracked.
  [[nodiscard]] float seconds_lost() const { return state_.seconds_lost; }
  // The current or last position.
  [[nodiscard]] Square square() const { return {state_.crop.center, state_.crop.side}; }
  // Roll of the crop in radians, clockwise.
  [[nodiscard]] float roll() const { return state_.crop.roll; }
  [[nodiscard]] Neutral& neutral(std::int32_t level) { return decoders_.neutral(level); }
  [[nodiscard]] const Neutral& neutral(std::int32_t level) const {
    return decoders_.neutral(level);
  }
  // Bit i: control i is supported at this level, or fading out from another level.
  [[nodiscard]] std::uint64_t supported_controls(std::int32_t level) const {
    const bool is_visible = is_known() && seconds_lost() < kRememberedSeconds;
    return decoders_.supported_controls(level) | (is_visible ? decoders_.active_controls() : 0);
  }

  // Clears all state.
  void reset(std::int32_t level);
  // The size of the image has changed: stops tracking and converts the last position.
  void change_geometry(const ImageGeometry& before, const ImageGeometry& now);
  // Resets the decoders after a discontinuity.
  void cut(std::int32_t level) { decoders_.reset(level); }

  // Verifies a detection after `alignments` alignments of the crop to its landmarks. If it is a
  // face, `encoding` receives its features and landmarks.
  [[nodiscard]] bool find(Frame& frame, const Detection& detection, int alignments,
                          Encoding& encoding);
  // Starts to track a verified face; returns false if its landmarks give no valid crop.
  [[nodiscard]] bool start_tracking(Frame& frame, const Encoding& encoding, std::uint32_t id);
  // No detection in the image.
  void mark_absent() { state_.face_probability = 0.0f; }

  // Encodes the crop at the last position.
  void track(Frame& frame);
  // Counts a frame without the face.
  void mark_missed(const Frame& frame);
  // The weight of video for each control, 0..1. It rises and falls over a few frames after the face
  // appears or is lost.
  [[nodiscard]] std::array<float, kControls> video_weights() const;
  // Computes one frame of output: decodes controls if the face is tracked, otherwise fades them.
  void animate(Frame& frame);

  // Writes the fields of this face to the result. Called once per frame.
  void publish(const Frame& frame);
  [[nodiscard]] const mien_result& result() const { return result_; }
  [[nodiscard]] mien_result& result() { return result_; }

 private:
  struct State {
    std::uint32_t id = 0;
    bool tracked = false;               // `crop` and `encoding` are of a face
    bool alternate = false;             // encoders may skip the next frame
    bool has_hifinet_features = false;  // HiFiNet has run since level 1
    std::int32_t misses = 0;            // consecutive encoded frames without the face
    Crop crop;                          // for the next frame
    Encoding encoding;                  // the latest one of the face
    Features hifinet_features = {};     // of its latest run
    Landmarks refinement = {};          // by HiFiNet, of BaseNet's landmarks, in sides of the crop
    FaceOutput raw;
    FaceOutput smoothed;
    bool is_new = true;  // no previous output to smooth with
    mien_face_status status = MIEN_FACE_SEARCHING;
    float seconds_lost = 0.0f;
    float presence = 0.0f;
    float face_probability = 0.0f;  // of the latest crop
    std::uint32_t flags = 0;        // MIEN_RESULT_* of this frame
  };

  [[nodiscard]] bool encode(Frame& frame, const Crop& crop, Encoding& encoding);
  [[nodiscard]] bool accept(const Frame& frame, const Encoding& encoding);
  void encode_hifinet(Frame& frame);
  [[nodiscard]] Landmarks landmarks(std::int32_t level) const;
  void smooth(float seconds);
  void fade(float seconds);

  const mien_tracker_config& config_;
  Encoders& encoders_;
  Decoders decoders_;
  State state_;
  mien_result result_ = {};
};

}  // namespace mien::tracker
