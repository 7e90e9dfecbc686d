// Connects the live loop to its page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/animation/frame.h"
#include "apps/mien/live/profile.h"
#include "apps/mien/live/screen.h"
#include "apps/mien/live_page/board.h"
#include "apps/mien/live_page/page_server.h"

namespace mien::app {

// What the page shows in addition to the screen.
struct PageState {
  std::string profile_file;  // empty: the page offers the profile as a download
  std::string message;       // the outcome of the last command; may be empty
  std::uint64_t saved = 0;   // number of times that the profile was saved
};

class PageLink {
 public:
  // `devices`: inputs that the page may select although they are not listed. Throws Failure.
  PageLink(std::uint16_t port, const std::string& token, std::vector<std::string> devices)
      : server_(port, token, board_, std::move(devices)) {}

  [[nodiscard]] const std::string& url() const { return server_.url(); }
  std::optional<PageCommand> next_command() { return board_.next_command(); }

  // `sent`: as the senders got it; `raw`: before the profile and before mirroring.
  void show(const animation::Frame& sent, const animation::Frame& raw);
  // Copies the image if a browser waits for it.
  void show(const mien_image& image);
  void show(const ScreenState& screen, const PageState& page, const LiveStatistics& statistics,
            const Profile& profile);
  void offer_profile(const Profile& profile) { board_.put_profile(profile_text(profile)); }

 private:
  Board board_;
  PageServer server_;
};

}  // namespace mien::app
