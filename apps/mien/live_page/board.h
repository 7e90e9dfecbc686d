// What the live loop and the connections of its page exchange. Only the latest of everything is
// kept, so a slow client gets fewer frames, but no late ones, and memory stays constant.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "apps/mien/live_page/command.h"

namespace mien::app {

class Board {
 public:
  // The latest texts; a number changes with its text and is 0 before the first.
  struct News {
    std::uint64_t frame_number = 0, state_number = 0;
    std::string frame, state;
  };

  // Called by the live loop. Texts are JSON without line feeds.
  void put_frame(std::string frame);
  void put_state(std::string state);  // without effect if it has not changed
  [[nodiscard]] bool preview_wanted();
  void put_preview(std::string image);
  void put_profile(std::string profile);
  std::optional<PageCommand> next_command();

  // Called by connections. Waits until a text differs from that in `news`, and copies the
  // changed texts. Returns false if none changes in time.
  bool wait(News& news, std::chrono::milliseconds within);
  // Waits for a preview taken after this call; empty if the time passes without one.
  std::string preview(std::chrono::milliseconds within);
  [[nodiscard]] std::string profile();  // empty if none was put
  // Returns false if too many commands wait.
  bool add_command(PageCommand command);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  News latest_;
  std::string preview_, profile_;
  std::uint64_t preview_number_ = 0;
  int preview_readers_ = 0;
  std::deque<PageCommand> commands_;
};

}  // namespace mien::app
