// Hands data from thread to thread.
#include "apps/mien/live_page/board.h"

#include <utility>

namespace mien::app {
namespace {

constexpr std::size_t kMaxCommands = 64;

}  // namespace

void Board::put_frame(std::string frame) {
  {
    const std::lock_guard lock(mutex_);
    latest_.frame = std::move(frame);
    ++latest_.frame_number;
  }
  changed_.notify_all();
}

void Board::put_state(std::string state) {
  {
    const std::lock_guard lock(mutex_);
    if (state == latest_.state) {
      return;
    }
    latest_.state = std::move(state);
    ++latest_.state_number;
  }
  changed_.notify_all();
}

bool Board::preview_wanted() {
  const std::lock_guard lock(mutex_);
  return preview_readers_ > 0;
}

void Board::put_preview(std::string image) {
  {
    const std::lock_guard lock(mutex_);
    preview_ = std::move(image);
    ++preview_number_;
  }
  changed_.notify_all();
}

void Board::put_profile(std::string profile) {
  const std::lock_guard lock(mutex_);
  profile_ = std::move(profile);
}

std::string Board::profile() {
  const std::lock_guard lock(mutex_);
  return profile_;
}

std::optional<PageCommand> Board::next_command() {
  const std::lock_guard lock(mutex_);
  if (commands_.empty()) {
    return std::nullopt;
  }
  PageCommand command = std::move(commands_.front());
  commands_.pop_front();
  return command;
}

bool Board::wait(News& news, std::chrono::milliseconds within) {
  std::unique_lock lock(mutex_);
  const auto differs = [&] {
    return news.frame_number != latest_.frame_number || news.state_number != latest_.state_number;
  };
  if (!changed_.wait_for(lock, within, differs)) {
    return false;
  }
  news.frame = news.frame_number != latest_.frame_number ? latest_.frame : "";
  news.state = news.state_number != latest_.state_number ? latest_.state : "";
  news.frame_number = latest_.frame_number;
  news.state_number = latest_.state_number;
  return true;
}

std::string Board::preview(std::chrono::milliseconds within) {
  std::unique_lock lock(mutex_);
  const std::uint64_t before = preview_number_;
  ++preview_readers_;
  const bool came = changed_.wait_for(lock, within, [&] { return preview_number_ != before; });
  --preview_readers_;
  return came ? preview_ : "";
}

bool Board::add_command(PageCommand command) {
  const std::lock_guard lock(mutex_);
  if (commands_.size() >= kMaxCommands) {
    return false;
  }
  commands_.push_back(std::move(command));
  return true;
}

}  // namespace mien::app
