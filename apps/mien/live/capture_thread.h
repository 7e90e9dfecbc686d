// What cameras and microphones have in common: a thread that waits for what they give. That of a
// file comes as if it happened; a device that is gone is opened anew every second.
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

// What a name of a file that is replayed begins with.
inline constexpr std::string_view kTest = "test:";

inline std::chrono::steady_clock::time_point steady_point(std::int64_t time_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns));
}

// How long it takes until all of it is there.
inline std::int64_t lasts_ns(const mien_image& /*image*/) { return 0; }
inline std::int64_t lasts_ns(const Audio& block) {
  return static_cast<std::int64_t>(block.frames) * 1'000'000'000 / block.sample_rate;
}

// File and Device give Blocks by `next`.
template <typename File, typename Device, typename Block>
class CaptureThread {
 public:
  CaptureThread(const CaptureThread&) = delete;
  CaptureThread& operator=(const CaptureThread&) = delete;

  // A file's time 0 is this. A device is opened; throws Failure when its name is not understood.
  void start(std::int64_t begin_ns) {
    if (file_) {
      thread_ = std::thread([this, begin_ns] { replay(begin_ns); });
    } else {
      device_ = std::make_unique<Device>(name_);
      thread_ = std::thread([this] { capture(); });
    }
  }

  // Why nothing comes at present; empty while something does.
  [[nodiscard]] std::string trouble() {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }

  // Opens a device anew, because it is silent.
  void restart(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (device_ && trouble_.empty()) {
      restart_reason_ = why;
      device_->interrupt();
    }
  }

 protected:
  // `file` is null for a device. One that is not there from the beginning is waited for, or is a
  // failure: a mistake, not a cable that fell out.
  CaptureThread(std::string name, std::unique_ptr<File> file, bool waits_from_the_beginning)
      : name_(std::move(name)), file_(std::move(file)), waits_(waits_from_the_beginning) {
    more_ = file_ && file_->next(block_, block_ns_);
  }
  virtual ~CaptureThread() = default;

  // Called by whoever inherits, before it is gone.
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

  // In the thread: what was captured at that time, and was here at that.
  virtual void take(const Block& block, std::int64_t time_ns, std::int64_t there_ns) = 0;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool file_is_empty() const { return file_ && !more_; }

  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  bool ended_ = false;  // no more will come
  std::exception_ptr failure_;

 private:
  static constexpr std::int64_t kRetryNs = 1'000'000'000;

  // False when it is to end.
  bool sleep_until(std::int64_t time_ns) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_until(lock, steady_point(time_ns), [&] { return stopping_; });
  }

  void replay(std::int64_t begin_ns) {
    std::exception_ptr failure;
    std::string trouble;
    try {
      for (; more_; more_ = file_->next(block_, block_ns_)) {
        const std::int64_t due_ns = begin_ns + block_ns_ + lasts_ns(block_);
        const std::int64_t there_ns = std::max(due_ns, steady_now_ns());
        if (!sleep_until(due_ns)) {
          break;
        }
        take(block_, begin_ns + block_ns_, there_ns);
      }
    } catch (const Failure& failed) {
      failure = std::current_exception();
      trouble = failed.what();
    }
    {
      const std::lock_guard lock(mutex_);
      failure_ = failure;
      trouble_ = trouble;
      ended_ = true;
    }
    changed_.notify_all();
  }

  void capture() {
    while (capture_once() && sleep_until(steady_now_ns() + kRetryNs)) {
    }
  }

  // From opening it until it is gone. False when it is not to be waited for.
  bool capture_once() {
    std::exception_ptr failure;
    std::string reason;
    try {
      if (!open()) {
        return false;
      }
      while (device_->next(block_, block_ns_)) {
        note_there();
        take(block_, block_ns_, block_ns_);
      }
      reason = name_ + ": " + device_->reason();
    } catch (const Failure& failed) {
      failure = std::current_exception();
      reason = failed.what();
    }
    std::unique_ptr<Device> gone;  // which may take its time, without the lock
    {
      const std::lock_guard lock(mutex_);
      gone = std::move(device_);
      trouble_ = restart_reason_.empty() ? reason : name_ + ": " + restart_reason_;
      restart_reason_.clear();
      if (!waits_) {
        failure_ = failure ? failure : std::make_exception_ptr(Failure(kExitNoInput, reason));
      }
    }
    changed_.notify_all();
    return waits_;
  }

  // False when it is to end.
  bool open() {
    const std::lock_guard lock(mutex_);
    if (!device_) {
      device_ = std::make_unique<Device>(name_);
    }
    return !stopping_;
  }

  void note_there() {
    const std::lock_guard lock(mutex_);
    trouble_.clear();
    waits_ = true;
  }

  std::string name_;
  std::unique_ptr<File> file_;      // of test:FILE
  Block block_;                     // the file's next, or the device's newest; of the thread
  std::int64_t block_ns_ = 0;       // its time
  bool more_ = false;               // of the file
  bool waits_;                      // for a device that is not there
  bool stopping_ = false;           // the mutex's
  std::string trouble_;             // the mutex's
  std::string restart_reason_;      // the mutex's
  std::unique_ptr<Device> device_;  // the mutex's; made and gone by the thread alone
  std::thread thread_;
};

}  // namespace mien::app
