// An HTTP server for the pages of this program, on 127.0.0.1 only.
//
// Not a library: Debian's cpp-httplib is a shared library that links OpenSSL and Brotli, and
// Debian's library for WebSockets has no packages for the Windows, macOS and static builds. The
// page needs neither TLS nor WebSockets, because its clients are on this machine and events flow
// one way.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <thread>

#include "apps/mien/system/tcp_socket.h"
#include "apps/protocols/http.h"

namespace mien::app {

// The client of a request, for the function that answers it.
class HttpClient {
 public:
  HttpClient(TcpConnection& connection, const std::atomic<bool>& stopping)
      : connection_(connection), stopping_(stopping) {}

  // Returns false if the connection must be closed: the client is gone, or too slow.
  bool send(std::string_view bytes);
  // Whether the server ends; an endless response must then end as well.
  [[nodiscard]] bool stopping() const { return stopping_; }

 private:
  TcpConnection& connection_;
  const std::atomic<bool>& stopping_;
};

class HttpServer {
 public:
  // Answers a request in the thread of its connection. Returns false to close the connection.
  using Handler = std::function<bool(const protocols::HttpRequest& request, HttpClient& client)>;

  // Port 0 selects a free port. Throws Failure(kExitOutput) with the prefix `what`.
  HttpServer(std::uint16_t port, const std::string& what) : listener_(port, what) {}
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer();

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  // Must be called once.
  void start(Handler handler);

 private:
  struct Worker {
    std::thread thread;
    std::atomic<bool> is_done = false;
  };

  void listen();
  void accept(TcpConnection connection);
  void join_finished();
  void serve(TcpConnection& connection) const;
  protocols::HttpParse read(TcpConnection& connection, std::string& received,
                            protocols::HttpRequest& request) const;

  TcpListener listener_;
  Handler handler_;
  std::atomic<bool> stopping_ = false;
  std::list<Worker> workers_;  // used by the listening thread
  std::thread thread_;
};

}  // namespace mien::app
