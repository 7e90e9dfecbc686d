// Keeps the latest image of a camera.
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

// Copies the formats that video sources provide: RGB, I420, GRAY8.
void copy(const mien_image& image, CameraImage& into) {
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

Camera::Camera(const std::string& name, bool retries)
    : CaptureThread(name,
                    name.starts_with(kTest) ? open_video(name.substr(kTest.size()), {}) : nullptr,
                    retries) {
  if (file_is_empty()) {
    throw Failure(kExitNoVideo, name + ": no image");
  }
}

void Camera::start(std::int64_t begin_ns) {
  if (name() != "none") {
    CaptureThread::start(begin_ns);
  }
}

const CameraImage* Camera::newest(std::int64_t until_ns) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, steady_point(until_ns), [&] { return has_new_ || failure_ || ended_; });
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  if (!has_new_) {
    return nullptr;
  }
  has_new_ = false;
  std::swap(reading_, latest_);
  return &reading_;
}

bool Camera::ended() {
  const std::lock_guard lock(mutex_);
  return ended_ && !has_new_;
}

std::uint64_t Camera::dropped() {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void Camera::take(const mien_image& image, std::int64_t time_ns, std::int64_t arrival_ns) {
  copy(image, writing_);
  writing_.time_ns = time_ns;
  writing_.arrival_ns = arrival_ns;
  {
    const std::lock_guard lock(mutex_);
    std::swap(writing_, latest_);
    dropped_ += has_new_ ? 1 : 0;
    has_new_ = true;
  }
  changed_.notify_all();
}

}  // namespace mien::app
