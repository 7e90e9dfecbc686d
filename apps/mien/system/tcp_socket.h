// TCP sockets of a server that this machine alone can reach.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mien::app {

// A connection that a client opened. It may be used by one thread only.
class TcpConnection {
 public:
  enum class Received { kBytes, kNothing, kClosed };

  TcpConnection(TcpConnection&& other) noexcept;
  TcpConnection& operator=(TcpConnection&&) = delete;
  ~TcpConnection();

  // Appends at most `max_bytes`. Waits for the first of them until the time has passed.
  Received receive(std::string& bytes, std::size_t max_bytes, std::chrono::milliseconds within);
  // Returns false if the client has closed, or does not accept all bytes within the time.
  bool send(std::string_view bytes, std::chrono::milliseconds within);

 private:
  friend class TcpListener;
  explicit TcpConnection(std::intptr_t handle) : handle_(handle) {}

  std::intptr_t handle_;
};

class TcpListener {
 public:
  // Listens on 127.0.0.1. Port 0 selects a free port. Throws Failure(kExitOutput) with the prefix
  // `what`.
  TcpListener(std::uint16_t port, const std::string& what);
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;
  ~TcpListener();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  // Returns the next connection, or nothing after the time has passed.
  std::optional<TcpConnection> accept(std::chrono::milliseconds within);

 private:
  std::intptr_t handle_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace mien::app
