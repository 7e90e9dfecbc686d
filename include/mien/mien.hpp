/// @file
/// C++20 wrapper of the C API: header only, no exceptions. mien.h documents parameters, units,
/// ranges and statuses; a member function has those of the C function that it calls.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace mien {

/// See mien_status_string.
[[nodiscard]] inline const char* message(mien_status status) { return mien_status_string(status); }

/// See mien_control_name.
/// @return empty outside 0..MIEN_CONTROL_COUNT - 1
inline std::string_view control_name(std::int32_t control) {
  const char* name = mien_control_name(control);
  return name != nullptr ? name : std::string_view();
}

/// See mien_landmark_group_name.
/// @return empty outside 0..MIEN_LANDMARK_GROUP_COUNT - 1
inline std::string_view landmark_group_name(std::int32_t group) {
  const char* name = mien_landmark_group_name(group);
  return name != nullptr ? name : std::string_view();
}

/// An image, initialized by mien_image_default.
struct Image : mien_image {
  Image() : mien_image() { mien_image_default(this); }
};

/// An audio block, initialized by mien_audio_default.
struct Audio : mien_audio {
  Audio() : mien_audio() { mien_audio_default(this); }
};

/// A configuration, initialized by mien_tracker_config_default.
struct Config : mien_tracker_config {
  /// Sets the required weights. They are not copied and must outlive every tracker created from
  /// this configuration.
  /// @param basenet_file   content of basenet.mien, MIEN_ALIGNMENT-aligned
  /// @param proposal_file  content of proposal.mien, MIEN_ALIGNMENT-aligned
  Config(std::span<const std::byte> basenet_file, std::span<const std::byte> proposal_file)
      : mien_tracker_config() {
    mien_tracker_config_default(this);
    basenet = basenet_file.data();
    basenet_bytes = basenet_file.size();
    proposal = proposal_file.data();
    proposal_bytes = proposal_file.size();
  }
};

/// A result, initialized by mien_result_default.
struct Result : mien_result {
  Result() : mien_result() { mien_result_default(this); }
  [[nodiscard]] bool has_face() const { return status == MIEN_FACE_TRACKING; }
  /// @param control  0..MIEN_CONTROL_COUNT - 1
  /// @return whether the control is predicted (supported_controls)
  [[nodiscard]] bool supports(std::int32_t control) const {
    return ((supported_controls >> control) & 1u) != 0;
  }
  /// @param control  which control
  /// @return 0..1; 0 if it is not supported
  [[nodiscard]] float control(mien_control control) const { return controls[control]; }
  /// @param group  which landmarks
  /// @return x and y of each landmark of the group, in pixels of the upright image
  [[nodiscard]] std::span<const float[2]> landmarks_of(mien_landmark_group group) const {
    std::int32_t first = 0;
    const std::int32_t count = mien_landmark_group_range(group, &first);
    return {landmarks + first, static_cast<std::size_t>(count)};
  }
};

/// Owns a mien_tracker. Empty until `create` or `create_in` succeeds; the functions of an empty one
/// return MIEN_ERROR_NULL_ARGUMENT.
class Tracker {
 public:
  /// See mien_tracker_create. An error leaves *this unchanged.
  [[nodiscard]] mien_status create(const mien_tracker_config& config) {
    mien_tracker* created = nullptr;
    const mien_status status = mien_tracker_create(&config, &created);
    return take_over(status, created);
  }

  /// See mien_tracker_create_in. An error leaves *this unchanged.
  /// @param config  configuration
  /// @param memory  [required_bytes or more], MIEN_ALIGNMENT-aligned; must outlive the tracker
  [[nodiscard]] mien_status create_in(const mien_tracker_config& config,
                                      std::span<std::byte> memory) {
    mien_tracker* created = nullptr;
    const mien_status status =
        mien_tracker_create_in(&config, memory.data(), memory.size(), &created);
    return take_over(status, created);
  }

  /// See mien_tracker_push_video.
  [[nodiscard]] mien_status push_video(const mien_image& image, std::int64_t pts_ns) {
    return mien_tracker_push_video(tracker_.get(), &image, pts_ns);
  }

  /// See mien_tracker_advance.
  [[nodiscard]] mien_status advance(std::int64_t pts_ns) {
    return mien_tracker_advance(tracker_.get(), pts_ns);
  }

  /// See mien_tracker_push_audio.
  [[nodiscard]] mien_status push_audio(const mien_audio& audio, std::int64_t pts_ns) {
    return mien_tracker_push_audio(tracker_.get(), &audio, pts_ns);
  }

  /// See mien_tracker_queue_audio.
  [[nodiscard]] mien_status queue_audio(const mien_audio& audio, std::int64_t pts_ns) {
    return mien_tracker_queue_audio(tracker_.get(), &audio, pts_ns);
  }

  /// See mien_tracker_set_audio_offset.
  [[nodiscard]] mien_status set_audio_offset(std::int64_t offset_ns) {
    return mien_tracker_set_audio_offset(tracker_.get(), offset_ns);
  }

  /// See mien_tracker_set_mix.
  [[nodiscard]] mien_status set_mix(std::int32_t control, float audio_weight, float video_weight) {
    return mien_tracker_set_mix(tracker_.get(), control, audio_weight, video_weight);
  }

  /// See mien_tracker_get_result.
  [[nodiscard]] mien_status get_result(mien_result& result) const {
    return mien_tracker_get_result(tracker_.get(), &result);
  }

  /// See mien_tracker_face_count.
  [[nodiscard]] std::int32_t face_count() const { return mien_tracker_face_count(tracker_.get()); }

  /// See mien_tracker_get_face.
  [[nodiscard]] mien_status get_face(std::int32_t index, mien_result& result) const {
    return mien_tracker_get_face(tracker_.get(), index, &result);
  }

  /// See mien_tracker_set_lod.
  [[nodiscard]] mien_status set_lod(std::int32_t lod) {
    return mien_tracker_set_lod(tracker_.get(), lod);
  }

  /// See mien_tracker_capture_neutral.
  [[nodiscard]] mien_status capture_neutral() {
    return mien_tracker_capture_neutral(tracker_.get());
  }

  /// See mien_tracker_save_neutral.
  [[nodiscard]] mien_status save_neutral(std::span<std::byte, MIEN_NEUTRAL_BYTES> file,
                                         std::uint32_t& captured) const {
    return mien_tracker_save_neutral(tracker_.get(), file.data(), file.size(), &captured);
  }

  /// See mien_tracker_load_neutral.
  [[nodiscard]] mien_status load_neutral(std::span<const std::byte> file) {
    return mien_tracker_load_neutral(tracker_.get(), file.data(), file.size());
  }

  /// See mien_tracker_reset.
  [[nodiscard]] mien_status reset() { return mien_tracker_reset(tracker_.get()); }

  explicit operator bool() const { return tracker_ != nullptr; }
  [[nodiscard]] mien_tracker* get() const { return tracker_.get(); }

 private:
  struct Destroy {
    void operator()(mien_tracker* tracker) const { mien_tracker_destroy(tracker); }
  };

  [[nodiscard]] mien_status take_over(mien_status status, mien_tracker* created) {
    if (status == MIEN_OK) {
      tracker_.reset(created);
    }
    return status;
  }

  std::unique_ptr<mien_tracker, Destroy> tracker_;
};

/// See mien_tracker_required_bytes.
/// @param config  configuration
/// @param status  receives MIEN_OK or the error
/// @return size in bytes of the memory for Tracker::create_in; 0 on error
[[nodiscard]] inline std::size_t required_bytes(const mien_tracker_config& config,
                                                mien_status& status) {
  std::size_t bytes = 0;
  status = mien_tracker_required_bytes(&config, &bytes);
  return bytes;
}

}  // namespace mien
