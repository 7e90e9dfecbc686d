// The newest picture of a camera. Pictures that nobody has taken when the next one comes are
// dropped: whoever is slow sees fewer pictures, and never old ones.
#pragma once

#include <mien/mien.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/mien/sources/live_source.h"
#include "apps/mien/sources/video_source.h"

namespace mien::app {

struct Picture {
  mien_image image;  // points into pixels
  std::vector<std::byte> pixels;
  std::int64_t time_ns = 0;   // on the steady clock, when it was taken
  std::int64_t there_ns = 0;  // when it was here: later, where decoding was late
};

class Camera {
 public:
  // "none": no pictures; "test:FILE": those of a file, as if they happened; else a device or a URL.
  // Throws Failure when a file gives no picture.
  explicit Camera(const std::string& name);
  ~Camera();
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  // A file's time 0 is this.
  // A device is opened; throws Failure when its name is not understood.
  void start(std::int64_t begin_ns);

  // The newest that was not taken yet, waited for until then; nullptr when there is none. Valid
  // until the next call. Throws what made the camera fail before it gave any.
  const Picture* newest(std::int64_t until_ns);

  // No more pictures will come: the file has ended.
  [[nodiscard]] bool ended();
  // Why there are none at present; empty while there are.
  [[nodiscard]] std::string trouble();
  [[nodiscard]] std::uint64_t dropped();
  // Opens it anew, because it is silent.
  void restart(const std::string& why);

 private:
  void replay();
  void capture();
  bool capture_once();
  void deliver(const mien_image& image, std::int64_t time_ns, std::int64_t there_ns);
  bool sleep_until(std::int64_t time_ns);  // false when it is to end

  std::string name_;
  std::unique_ptr<VideoSource> file_;  // of test:FILE
  mien_image image_;                   // its next
  std::int64_t image_pts_ns_ = 0;
  std::int64_t begin_ns_ = 0;

  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  Picture waiting_;
  bool fresh_ = false;
  bool stopping_ = false, ended_ = false, ever_ = false;
  std::uint64_t dropped_ = 0;
  std::string trouble_;
  std::string restart_reason_;
  std::exception_ptr failure_;
  std::unique_ptr<LiveVideo> live_;

  Picture filling_;  // of the camera's thread
  Picture taken_;    // of the taker's
  std::thread thread_;
};

}  // namespace mien::app
