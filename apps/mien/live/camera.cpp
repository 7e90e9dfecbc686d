#include "apps/mien/live/camera.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

constexpr std::int64_t kRetryNs = 1'000'000'000;
constexpr const char* kTest = "test:";

std::chrono::steady_clock::time_point point(std::int64_t time_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns));
}

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

Camera::Camera(const std::string& name) : name_(name) {
  if (name_.starts_with(kTest)) {
    file_ = open_video(name_.substr(std::strlen(kTest)), {});
    if (!file_->next(image_, image_pts_ns_)) {
      throw Failure(kExitNoVideo, name_ + ": has no picture");
    }
  }
}

Camera::~Camera() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (live_) {
      live_->interrupt();
    }
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Camera::start(std::int64_t begin_ns) {
  begin_ns_ = begin_ns;
  if (file_) {
    thread_ = std::thread(&Camera::replay, this);
  } else if (name_ != "none") {
    live_ = std::make_unique<LiveVideo>(name_);
    thread_ = std::thread(&Camera::capture, this);
  }
}

const Picture* Camera::newest(std::int64_t until_ns) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, point(until_ns), [&] { return fresh_ || failure_ || ended_; });
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

std::string Camera::trouble() {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

std::uint64_t Camera::dropped() {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void Camera::restart(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (live_ && trouble_.empty()) {
    restart_reason_ = why;
    live_->interrupt();
  }
}

void Camera::deliver(const mien_image& image, std::int64_t time_ns, std::int64_t there_ns) {
  copy(image, filling_);
  filling_.time_ns = time_ns;
  filling_.there_ns = there_ns;
  {
    const std::lock_guard lock(mutex_);
    std::swap(filling_, waiting_);
    dropped_ += fresh_ ? 1 : 0;
    fresh_ = ever_ = true;
    trouble_.clear();
  }
  changed_.notify_all();
}

bool Camera::sleep_until(std::int64_t time_ns) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_until(lock, point(time_ns), [&] { return stopping_; });
}

void Camera::replay() {
  std::exception_ptr failure;
  try {
    do {
      const std::int64_t due_ns = begin_ns_ + image_pts_ns_;
      const std::int64_t there_ns = std::max(due_ns, steady_now_ns());
      if (!sleep_until(due_ns)) {
        break;
      }
      deliver(image_, due_ns, there_ns);
    } while (file_->next(image_, image_pts_ns_));
  } catch (const Failure&) {
    failure = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    ended_ = true;
  }
  changed_.notify_all();
}

void Camera::capture() {
  while (capture_once()) {
    bool again = false;
    while (!again && sleep_until(steady_now_ns() + kRetryNs)) {
      const std::lock_guard lock(mutex_);
      if (stopping_) {
        return;
      }
      try {
        live_ = std::make_unique<LiveVideo>(name_);
        again = true;
      } catch (const Failure& failure) {  // no ffmpeg any more
        trouble_ = failure.what();
      }
    }
    if (!again) {
      return;
    }
  }
}

// From opening it until it is gone. False when it is not to be waited for.
bool Camera::capture_once() {
  std::exception_ptr failure;
  std::string reason;
  try {
    live_->open();
    mien_image image;
    std::int64_t time_ns = 0;
    while (live_->next(image, time_ns)) {
      deliver(image, time_ns, time_ns);
    }
    reason = name_ + ": " + live_->reason();
  } catch (const Failure& failed) {
    reason = failed.what();
    failure = std::current_exception();
  }
  std::unique_ptr<LiveVideo> gone;
  {
    const std::lock_guard lock(mutex_);
    gone = std::move(live_);
    trouble_ = restart_reason_.empty() ? reason : name_ + ": " + restart_reason_;
    restart_reason_.clear();
    if (!ever_) {  // what was never there is a mistake, not a cable that fell out
      failure_ = failure ? failure : std::make_exception_ptr(Failure(kExitNoInput, reason));
    }
  }
  changed_.notify_all();
  const std::lock_guard lock(mutex_);
  return ever_ && !stopping_;
}

}  // namespace mien::app
