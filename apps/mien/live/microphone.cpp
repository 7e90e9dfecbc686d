#include "apps/mien/live/microphone.h"

#include <chrono>
#include <cstring>
#include <utility>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

constexpr std::int64_t kRetryNs = 1'000'000'000;
constexpr const char* kTest = "test:";

std::int64_t duration_ns(const Audio& block) {
  return static_cast<std::int64_t>(block.frames) * 1'000'000'000 / block.sample_rate;
}

}  // namespace

Microphone::Microphone(const std::string& name, Tracker& tracker) : name_(name), tracker_(tracker) {
  if (name_.starts_with(kTest)) {
    file_ = open_sound(name_.substr(std::strlen(kTest)), {});
  }
}

Microphone::~Microphone() {
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

void Microphone::start(std::int64_t begin_ns) {
  begin_ns_ = begin_ns;
  thread_ = std::thread(file_ ? &Microphone::replay : &Microphone::listen, this);
}

std::string Microphone::trouble() {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

bool Microphone::ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

bool Microphone::sleep_until(std::int64_t time_ns) {
  std::unique_lock lock(mutex_);
  const std::chrono::steady_clock::time_point then{std::chrono::nanoseconds(time_ns)};
  return !changed_.wait_until(lock, then, [&] { return stopping_; });
}

// A queue that is full means that nobody asks for pictures; what is missing then is a gap.
void Microphone::hear(const Audio& block, std::int64_t time_ns) {
  const mien_status status = tracker_.queue_audio(block, time_ns);
  if (status != MIEN_OK && status != MIEN_ERROR_AUDIO_QUEUE_FULL) {
    throw Failure(kExitInternal, name_ + ": " + message(status));
  }
}

void Microphone::replay() {
  std::string trouble;
  try {
    Audio block;
    std::int64_t pts_ns = 0;
    while (file_->next(block, pts_ns) &&
           sleep_until(begin_ns_ + pts_ns + duration_ns(block))) {  // it is there once it is over
      hear(block, begin_ns_ + pts_ns);
    }
  } catch (const Failure& failure) {
    trouble = failure.what();
  }
  const std::lock_guard lock(mutex_);
  trouble_ = trouble;
  ended_ = true;
}

void Microphone::listen() {
  do {
    std::string trouble;
    try {
      {
        const std::lock_guard lock(mutex_);
        live_ = std::make_unique<LiveSound>(name_);
        if (stopping_) {
          return;
        }
      }
      listen_once();
      trouble = name_ + ": " + live_->reason();
    } catch (const Failure& failure) {
      trouble = failure.what();
    }
    const std::lock_guard lock(mutex_);
    live_.reset();
    trouble_ = trouble;
  } while (sleep_until(steady_now_ns() + kRetryNs));
}

void Microphone::listen_once() {
  Audio block;
  std::int64_t time_ns = 0;
  while (live_->next(block, time_ns)) {
    hear(block, time_ns);
    const std::lock_guard lock(mutex_);
    trouble_.clear();
  }
}

}  // namespace mien::app
