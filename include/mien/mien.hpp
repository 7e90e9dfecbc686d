/// @file
/// C++20 wrapper of the C API: header only, no exceptions. mien.h documents parameters, units,
/// ranges and statuses; a member function has those of the C function that it calls.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

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

/// What a function found wrong.
struct Error : mien_error_detail {
  Error() : mien_error_detail() { mien_error_detail_default(this); }
  /// See mien_error_message.
  [[nodiscard]] std::string message() const {
    std::string text(mien_error_message(this, nullptr, 0), '\0');
    mien_error_message(this, text.data(), text.size() + 1);
    return text;
  }
};

/// A share of mien_weights. Empty until `create` succeeds. Copies, trackers and networks share the
/// weights, which end with the last of them.
class Weights {
 public:
  /// See mien_weights_create, whose statuses it returns.
  /// @param files  content of .mien files, packed ones or bundles; at most MIEN_MAX_WEIGHT_FILES
  /// @param copy   whether to copy them; otherwise they must outlive the weights and all their
  /// users
  /// @param error  describes an error; may be nullptr. An error leaves *this unchanged.
  [[nodiscard]] mien_status create(std::span<const std::span<const std::byte>> files,
                                   bool copy = false, mien_error_detail* error = nullptr) {
    mien_weights_config config;
    mien_weights_config_default(&config);
    config.copy = copy ? 1 : 0;
    for (std::size_t i = 0; i < files.size() && i < MIEN_MAX_WEIGHT_FILES; ++i) {
      config.files[i] = files[i].data();
      config.file_bytes[i] = files[i].size();
    }
    return create(config, error);
  }
  /// See mien_weights_create. An error leaves *this unchanged.
  [[nodiscard]] mien_status create(const mien_weights_config& config,
                                   mien_error_detail* error = nullptr) {
    mien_weights* created = nullptr;
    const mien_status status = mien_weights_create(&config, &created, error);
    if (status == MIEN_OK) {
      weights_ = std::shared_ptr<mien_weights>(created, mien_weights_destroy);
    }
    return status;
  }

  explicit operator bool() const { return weights_ != nullptr; }
  /// @return nullptr if empty
  [[nodiscard]] const mien_weights* get() const { return weights_.get(); }

 private:
  std::shared_ptr<mien_weights> weights_;
};

/// Weights that load_weights loaded, or the reason why it could not.
struct LoadedWeights {
  Weights weights;      ///< empty on error
  std::string message;  ///< one line with the path on error; otherwise empty
  explicit operator bool() const { return static_cast<bool>(weights); }
};

/// Loads weights from files.
/// @param path  a .mien file, a packed one, a bundle, or a folder, from which basenet.mien,
///              proposal.mien, hifinet.mien and audionet.mien are loaded if they are there
/// @return the weights, or a message
[[nodiscard]] inline LoadedWeights load_weights(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> paths = {path};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    paths.clear();
    for (const char* name : {"basenet.mien", "proposal.mien", "hifinet.mien", "audionet.mien"}) {
      if (std::filesystem::exists(path / name, ignored)) {
        paths.push_back(path / name);
      }
    }
  }
  LoadedWeights loaded;
  if (paths.empty()) {
    loaded.message = path.string() + ": no weight files in this folder";
    return loaded;
  }
  std::vector<std::vector<char>> contents;
  std::vector<std::span<const std::byte>> files;
  files.reserve(paths.size());
  for (const std::filesystem::path& one : paths) {
    std::ifstream file(one, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    if (!file || contents.back().empty()) {
      loaded.message = one.string() + ": cannot be read, or is empty";
      return loaded;
    }
  }
  for (const std::vector<char>& content : contents) {
    files.push_back(std::as_bytes(std::span(content)));
  }
  Error error;
  if (loaded.weights.create(files, true, &error) != MIEN_OK) {
    const auto index = static_cast<std::size_t>(error.file < 0 ? 0 : error.file);
    loaded.message = paths[index].string() + ": " + error.message();
  }
  return loaded;
}

/// A configuration, initialized by mien_tracker_config_default.
struct Config : mien_tracker_config {
  /// @param shared  must not be empty; need not outlive the trackers
  explicit Config(const Weights& shared) : mien_tracker_config() {
    mien_tracker_config_default(this);
    weights = shared.get();
  }
};

/// A result, initialized by mien_result_default.
struct Result : mien_result {
  Result() : mien_result() { mien_result_default(this); }
  /// @return whether the face is tracked on this frame
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
  [[nodiscard]] mien_status create(const mien_tracker_config& config,
                                   mien_error_detail* error = nullptr) {
    mien_tracker* created = nullptr;
    const mien_status status = mien_tracker_create(&config, &created, error);
    return take_over(status, created);
  }

  /// See mien_tracker_create_in. An error leaves *this unchanged.
  /// @param config  configuration
  /// @param memory  [required_bytes or more], MIEN_ALIGNMENT-aligned; must outlive the tracker
  /// @param[out] error  describes the error; may be null
  [[nodiscard]] mien_status create_in(const mien_tracker_config& config,
                                      std::span<std::byte> memory,
                                      mien_error_detail* error = nullptr) {
    mien_tracker* created = nullptr;
    const mien_status status =
        mien_tracker_create_in(&config, memory.data(), memory.size(), &created, error);
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
  /// @return nullptr if empty
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
/// @param error   describes an error; may be nullptr
/// @return size in bytes of the memory for Tracker::create_in; 0 on error
[[nodiscard]] inline std::size_t required_bytes(const mien_tracker_config& config,
                                                mien_status& status,
                                                mien_error_detail* error = nullptr) {
  std::size_t bytes = 0;
  status = mien_tracker_required_bytes(&config, &bytes, error);
  return bytes;
}

}  // namespace mien
