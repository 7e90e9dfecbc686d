// The web server of `mien live --page`.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "apps/mien/live_page/board.h"
#include "apps/mien/live_page/http_server.h"

namespace mien::app {

class PageServer {
 public:
  // Port 0 selects a free port. `token`: the secret part of the URL. `board` must outlive the
  // server. The page may select the listed devices of this machine, `devices`, and "none". Throws
  // Failure(kExitOutput).
  PageServer(std::uint16_t port, const std::string& token, Board& board,
             std::vector<std::string> devices);

  // With the secret path that every request must begin with.
  [[nodiscard]] const std::string& url() const { return url_; }

 private:
  bool answer(const protocols::HttpRequest& request, HttpClient& client);
  // Whether the request knows the secret, and comes from a page of this server or from no page.
  // Otherwise any web site could reach the server through a name that it resolves to 127.0.0.1.
  [[nodiscard]] bool is_allowed(const protocols::HttpRequest& request) const;
  bool get(std::string_view page, HttpClient& client);
  bool post(std::string_view page, const protocols::HttpRequest& request, HttpClient& client);
  // Other names would make ffmpeg open files and network addresses for anyone with the URL.
  [[nodiscard]] bool may_open(const PageCommand& command) const;
  bool stream_events(HttpClient& client);
  bool send_preview(HttpClient& client);
  bool send_profile(HttpClient& client);

  Board& board_;
  std::vector<std::string> devices_;
  std::string page_, obs_page_;
  std::string host_, local_host_;  // accepted values of Host: 127.0.0.1:PORT, localhost:PORT
  std::string secret_path_;        // "/TOKEN/"
  std::string url_;
  HttpServer server_;  // last, because its threads use the other members
};

}  // namespace mien::app
