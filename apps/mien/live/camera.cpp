#include "apps/mien/live/camera.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace mien::app {
namespace {

struct Plane {
  std::size_t rows, last_row_bytes;
};

Plane plane_of(const mien_image& image, int plane) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  if (image.format == MIEN_IMAGE_RGB) {
    return plane == 0 ? Plane{height, 3 * width} : Plane{0, 0};
  }
  if (plane == 0) {
    return {height, width};
  }
  if (image.format != MIEN_IMAGE_I420) {
    return {0, 0};
  }
  const auto step = static_cast<std::size_t>(std::max(1, image.chroma_pixel_stride_bytes));
  return {(height + 1) / 2, ((width + 1) / 2 - 1) * step + 1};
}

// Of the formats that video sources give: RGB, I420, GRAY8.
void copy(const mien_image& image, Picture& into) {
  into.image = image;
  std::size_t offsets[3] = {}, bytes = 0;
  for (int i = 0; i < 3; ++i) {
    const Plane plane = plane_of(image, i);
    offsets[i] = bytes;
    if (plane.rows > 0) {
      bytes += (plane.rows - 1) * static_cast<std::size_t>(image.row_stride_bytes[i]) +
               plane.last_row_bytes;
    }
  }
  into.pixels.resize(bytes);
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = i < 2 ? offsets[i + 1] : bytes;
    if (end > offsets[i]) {
      std::memcpy(into.pixels.data() + offsets[i], image.planes[i], end - offsets[i]);
      into.image.planes[i] = into.pixels.data() + offsets[i];
    }
  }
}

}  // namespace

Camera::Camera(const std::string& name)
    : CaptureThread(name,
                    name.starts_with(kTest) ? open_video(name.substr(kTest.size()), {}) : nullptr,
                    false) {
  if (file_is_empty()) {
    throw Failure(kExitNoVideo, name + ": has no picture");
  }
}

void Camera::start(std::int64_t begin_ns) {
  if (name() != "none") {
    CaptureThread::start(begin_ns);
  }
}

const Picture* Camera::newest(std::int64_t until_ns) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, steady_point(until_ns), [&] { return fresh_ || failure_ || ended_; });
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  if (!fresh_) {
    return nullptr;
  }
  fresh_ = false;
  std::swap(taken_, waiting_);
  return &taken_;
}

bool Camera::ended() {
  const std::lock_guard lock(mutex_);
  return ended_ && !fresh_;
}

std::uint64_t Camera::dropped() {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void Camera::take(const mien_image& image, std::int64_t time_ns, std::int64_t there_ns) {
  copy(image, filling_);
  filling_.time_ns = time_ns;
  filling_.there_ns = there_ns;
  {
    const std::lock_guard lock(mutex_);
    std::swap(filling_, waiting_);
    dropped_ += fresh_ ? 1 : 0;
    fresh_ = true;
  }
  changed_.notify_all();
}

}  // namespace mien::app
