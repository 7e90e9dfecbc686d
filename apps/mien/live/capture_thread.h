// A thread that receives blocks from a camera, a microphone or a file. Files play in real time; a
// device that fails is reopened every second.
#pragma once

#include <mien/mien.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mien/mien.hpp>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "apps/mien/sources/live_source.h"
#include "apps/mien/system/failure.h"

namespace mien::app {

// The prefix of a file that is played as a device.
inline constexpr std::string_view kTest = "test:";

inline std::chrono::steady_clock::time_point steady_point(std::int64_t time_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns));
}

// The time from the capture of the first to the last sample.
inline std::int64_t duration_ns(const mien_image& /*image*/) { return 0; }
inline std::int64_t duration_ns(const Audio& block) {
  return static_cast<std::int64_t>(block.frames) * 1'000'000'000 / block.sample_rate;
}

// File and Device provide `next`, which returns blocks.
template <typename File, typename Device, typename Block>
class CaptureThread {
 public:
  CaptureThread(const CaptureThread&) = delete;
  CaptureThread& operator=(const CaptureThread&) = delete;

  // Starts the thread. `begin_ns` is time 0 of a file. Throws Failure for an invalid device name.
  void start(std::int64_t begin_ns) {
    if (file_) {
      thread_ = std::thread([this, begin_ns] { replay(begin_ns); });
    } else {
      device_ = std::make_unique<Device>(name_);
      thread_ = std::thread([this] { capture(); });
    }
  }

  // The reason why no blocks arrive; empty while they do.
  [[nodiscard]] std::string error() {
    const std::lock_guard lock(mutex_);
    return error_;
  }

  // Reopens a silent device.
  void restart(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (device_ && error_.empty()) {
      restart_reason_ = why;
      device_->interrupt();
    }
  }

 protected:
  // `file` is null for a device. `retry_first` decides whether a device that cannot be opened at
  // first is retried or is a failure: probably a typing error, not a loose cable.
  CaptureThread(std::string name, std::unique_ptr<File> file, bool retry_first)
      : name_(std::move(name)), file_(std::move(file)), retries_(retry_first) {
    more_ = file_ && file_->next(block_, block_ns_);
  }
  virtual ~CaptureThread() = default;

  // Must be called by derived destructors.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      if (device_) {
        device_->interrupt();
      }
    }
    changed_.notify_all();
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  // Called in the thread with each block, its capture time and its arrival time.
  virtual void take(const Block& block, std::int64_t time_ns, std::int64_t arrival_ns) = 0;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool file_is_empty() const { return file_ && !more_; }

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  bool ended_ = false;  // no more blocks will come
  std::exception_ptr failure_;

 private:
  static constexpr std::int64_t kRetryNs = 1'000'000'000;

  // Returns false if the thread must stop.
  bool sleep_until(std::int64_t time_ns) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_until(lock, steady_point(time_ns), [&] { return stopping_; });
  }

  void replay(std::int64_t begin_ns) {
    std::exception_ptr failure;
    std::string error;
    try {
      for (; more_; more_ = file_->next(block_, block_ns_)) {
        const std::int64_t due_ns = begin_ns + block_ns_ + duration_ns(block_);
        const std::int64_t arrival_ns = std::max(due_ns, steady_now_ns());
        if (!sleep_until(due_ns)) {
          break;
        }
        take(block_, begin_ns + block_ns_, arrival_ns);
      }
    } catch (const Failure& failed) {
      failure = std::current_exception();
      error = failed.what();
    }
    {
      const std::lock_guard lock(mutex_);
      failure_ = failure;
      error_ = error;
      ended_ = true;
    }
    changed_.notify_all();
  }

  void capture() {
    while (capture_once() && sleep_until(steady_now_ns() + kRetryNs)) {
    }
  }

  // Opens the device and reads it until it fails. Returns false if it must not be retried.
  bool capture_once() {
    std::exception_ptr failure;
    std::string reason;
    try {
      if (!open()) {
        return false;
      }
      while (device_->next(block_, block_ns_)) {
        note_delivery();
        take(block_, block_ns_, block_ns_);
      }
      reason = name_ + ": " + device_->reason();
    } catch (const Failure& failed) {
      failure = std::current_exception();
      reason = failed.what();
    }
    std::unique_ptr<Device>
        failed_device;  // destroyed without the lock, because that may take time
    {
      const std::lock_guard lock(mutex_);
      failed_device = std::move(device_);
      error_ = restart_reason_.empty() ? reason : name_ + ": " + restart_reason_;
      restart_reason_.clear();
      if (!retries_) {
        failure_ = failure ? failure : std::make_exception_ptr(Failure(kExitNoInput, reason));
      }
    }
    changed_.notify_all();
    return retries_;
  }

  // Returns false if the thread must stop.
  bool open() {
    const std::lock_guard lock(mutex_);
    if (!device_) {
      device_ = std::make_unique<Device>(name_);
    }
    return !stopping_;
  }

  void note_delivery() {
    const std::lock_guard lock(mutex_);
    error_.clear();
    retries_ = true;
  }

  std::string name_;
  std::unique_ptr<File> file_;  // of test:FILE
  Block block_;  // the next of the file, or the latest of the device; used by the thread only
  std::int64_t block_ns_ = 0;   // its timestamp
  bool more_ = false;           // the file has more blocks
  bool retries_;                // retry a device that cannot be opened
  bool stopping_ = false;       // guarded by the mutex
  std::string error_;           // guarded by the mutex
  std::string restart_reason_;  // guarded by the mutex
  std::unique_ptr<Device>
      device_;  // guarded by the mutex; created and destroyed by the thread only
  std::thread thread_;
};

}  // namespace mien::app
