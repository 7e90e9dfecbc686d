// mien for C++20: a thin layer over mien.h, header only, no exceptions. Everything is documented
// there.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace mien {

[[nodiscard]] inline const char* message(mien_status status) { return mien_status_string(status); }

inline std::string_view control_name(std::int32_t control) {
  const char* name = mien_control_name(control);
  return name != nullptr ? name : std::string_view();
}

struct Image : mien_image {
  Image() : mien_image() { mien_image_default(this); }
};

struct Audio : mien_audio {
  Audio() : mien_audio() { mien_audio_default(this); }
};

struct Config : mien_tracker_config {
  // The weights (.mien files) are not copied and must outlive every tracker made of this.
  Config(std::span<const std::byte> basenet_file, std::span<const std::byte> proposal_file)
      : mien_tracker_config() {
    mien_tracker_config_default(this);
    basenet = basenet_file.data();
    basenet_bytes = basenet_file.size();
    proposal = proposal_file.data();
    proposal_bytes = proposal_file.size();
  }
};

struct Result : mien_result {
  Result() : mien_result() { mien_result_default(this); }
  [[nodiscard]] bool has_face() const { return status == MIEN_FACE_TRACKING; }
  [[nodiscard]] bool supports(std::int32_t control) const {
    return ((supported_controls >> control) & 1u) != 0;
  }
};

// Owns a mien_tracker. Empty until `create` succeeds; the functions of an empty one return
// MIEN_ERROR_NULL_ARGUMENT.
class Tracker {
 public:
  // On error *this stays as it was.
  [[nodiscard]] mien_status create(const mien_tracker_config& config) {
    mien_tracker* created = nullptr;
    const mien_status status = mien_tracker_create(&config, &created);
    return adopt(status, created);
  }

  // In the caller's memory, MIEN_ALIGNMENT-aligned, which must outlive the tracker.
  [[nodiscard]] mien_status create_in(const mien_tracker_config& config,
                                      std::span<std::byte> memory) {
    mien_tracker* created = nullptr;
    const mien_status status =
        mien_tracker_create_in(&config, memory.data(), memory.size(), &created);
    return adopt(status, created);
  }

  [[nodiscard]] mien_status push_video(const mien_image& image, std::int64_t pts_ns) {
    return mien_tracker_push_video(tracker_.get(), &image, pts_ns);
  }

  [[nodiscard]] mien_status advance(std::int64_t pts_ns) {
    return mien_tracker_advance(tracker_.get(), pts_ns);
  }

  [[nodiscard]] mien_status push_audio(const mien_audio& audio, std::int64_t pts_ns) {
    return mien_tracker_push_audio(tracker_.get(), &audio, pts_ns);
  }

  [[nodiscard]] mien_status queue_audio(const mien_audio& audio, std::int64_t pts_ns) {
    return mien_tracker_queue_audio(tracker_.get(), &audio, pts_ns);
  }

  [[nodiscard]] mien_status set_audio_offset(std::int64_t offset_ns) {
    return mien_tracker_set_audio_offset(tracker_.get(), offset_ns);
  }

  [[nodiscard]] mien_status set_mix(std::int32_t control, float audio_weight, float video_weight) {
    return mien_tracker_set_mix(tracker_.get(), control, audio_weight, video_weight);
  }

  [[nodiscard]] mien_status get_result(mien_result& result) const {
    return mien_tracker_get_result(tracker_.get(), &result);
  }

  [[nodiscard]] std::int32_t face_count() const { return mien_tracker_face_count(tracker_.get()); }

  [[nodiscard]] mien_status get_face(std::int32_t index, mien_result& result) const {
    return mien_tracker_get_face(tracker_.get(), index, &result);
  }

  [[nodiscard]] mien_status set_lod(std::int32_t lod) {
    return mien_tracker_set_lod(tracker_.get(), lod);
  }

  [[nodiscard]] mien_status capture_neutral() {
    return mien_tracker_capture_neutral(tracker_.get());
  }

  [[nodiscard]] mien_status save_neutral(std::span<std::byte, MIEN_NEUTRAL_BYTES> file,
                                         std::uint32_t& captured) const {
    return mien_tracker_save_neutral(tracker_.get(), file.data(), file.size(), &captured);
  }

  [[nodiscard]] mien_status load_neutral(std::span<const std::byte> file) {
    return mien_tracker_load_neutral(tracker_.get(), file.data(), file.size());
  }

  [[nodiscard]] mien_status reset() { return mien_tracker_reset(tracker_.get()); }

  explicit operator bool() const { return tracker_ != nullptr; }
  [[nodiscard]] mien_tracker* get() const { return tracker_.get(); }

 private:
  struct Destroy {
    void operator()(mien_tracker* tracker) const { mien_tracker_destroy(tracker); }
  };

  [[nodiscard]] mien_status adopt(mien_status status, mien_tracker* created) {
    if (status == MIEN_OK) {
      tracker_.reset(created);
    }
    return status;
  }

  std::unique_ptr<mien_tracker, Destroy> tracker_;
};

// The bytes that Tracker::create_in needs; 0 and the reason in `status` on error.
[[nodiscard]] inline std::size_t required_bytes(const mien_tracker_config& config,
                                                mien_status& status) {
  std::size_t bytes = 0;
  status = mien_tracker_required_bytes(&config, &bytes);
  return bytes;
}

}  // namespace mien
