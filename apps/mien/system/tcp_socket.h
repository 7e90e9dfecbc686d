// TCP sockets: clients, and servers that this machine alone can reach.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "apps/mien/system/socket_address.h"

namespace mien::app {

// It may be used by one thread only.
class TcpConnection {
 public:
  enum class Received { kBytes, kNothing, kClosed };
  enum class Connected { kYes, kNotYet, kFailed };

  // Begins to connect, without waiting. A failure is reported by `connected`.
  explicit TcpConnection(const SocketAddress& server);
  TcpConnection(TcpConnection&& other) noexcept;
  TcpConnection& operator=(TcpConnection&&) = delete;
  ~TcpConnection();

  // Whether the connection to the server exists; does not wait. Sets `reason` if it returns
  // kFailed.
  [[nodiscard]] Connected connected(std::string& reason) const;

  // Appends at most `max_bytes`. Waits for the first of them until the time has passed.
  Received receive(std::string& bytes, std::size_t max_bytes, std::chrono::milliseconds within);
  // Returns false if the client has closed, or does not accept all bytes within the time.
  bool send(std::string_view bytes, std::chrono::milliseconds within);
  // Sends as much as possible without waiting, and removes it from `bytes`. Returns false if the
  // connection has failed.
  bool send_some(std::string& bytes);

 private:
  friend class TcpListener;
  explicit TcpConnection(std::intptr_t handle) : handle_(handle) {}

  std::intptr_t handle_;
  std::string connect_error_;
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
