// A microphone, heard by a tracker from a thread of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mien/mien.hpp>
#include <mutex>
#include <string>
#include <thread>

#include "apps/mien/sources/live_source.h"
#include "apps/mien/sources/sound_source.h"

namespace mien::app {

class Microphone {
 public:
  // "test:FILE": the sound of a file, as if it happened; else a device or a URL. The tracker has
  // room for half a second (mien_tracker_config.audio_queue_samples) and outlives this. Throws
  // Failure when a file has no sound.
  Microphone(const std::string& name, Tracker& tracker);
  ~Microphone();
  Microphone(const Microphone&) = delete;
  Microphone& operator=(const Microphone&) = delete;

  void start(std::int64_t begin_ns);  // a file's time 0 is this

  // Why nothing is heard at present; empty while something is. One that is not there is waited for.
  [[nodiscard]] std::string trouble();
  // No more will come: the file has ended.
  [[nodiscard]] bool ended();

 private:
  void replay();
  void listen();
  void listen_once();
  void hear(const Audio& block, std::int64_t time_ns);
  bool sleep_until(std::int64_t time_ns);  // false when it is to end

  std::string name_;
  Tracker& tracker_;
  std::unique_ptr<SoundSource> file_;  // of test:FILE
  std::int64_t begin_ns_ = 0;

  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  bool stopping_ = false, ended_ = false;
  std::string trouble_;
  std::unique_ptr<LiveSound> live_;

  std::thread thread_;
};

}  // namespace mien::app
