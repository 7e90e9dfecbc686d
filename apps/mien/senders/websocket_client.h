// A WebSocket connection to a server, without TLS. No function waits.
//
// Not a library: Debian's libwebsockets and IXWebSocket link TLS libraries and have no packages for
// the Windows, macOS and static builds; Boost.Beast, which is header-only, adds 390 KB to a
// program.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "apps/mien/system/socket_address.h"
#include "apps/mien/system/tcp_socket.h"
#include "apps/protocols/websocket.h"

namespace mien::app {

class WebSocketClient {
 public:
  // Begins to connect. `host`: the name and the port for the server.
  WebSocketClient(const SocketAddress& server, std::string host);
  ~WebSocketClient();  // sends a close frame
  WebSocketClient(const WebSocketClient&) = delete;
  WebSocketClient& operator=(const WebSocketClient&) = delete;

  // Sends and receives as much as possible now. Returns false if the connection has failed or
  // ended.
  bool update();
  [[nodiscard]] bool is_open() const { return phase_ == Phase::kOpen; }
  [[nodiscard]] const std::string& reason() const { return reason_; }  // of the end

  // The next text of the server, also after the end.
  [[nodiscard]] std::optional<std::string> receive();

  // Requires an open connection.
  void send(std::string_view text);
  // Whether everything has been handed to the operating system.
  [[nodiscard]] bool is_idle() const { return unsent_.empty(); }

 private:
  enum class Phase { kConnecting, kHandshake, kOpen, kClosed };

  bool end(std::string reason);
  bool check_connected();
  bool check_response();
  bool receive_bytes();
  void enqueue(protocols::WebSocketOpcode opcode, std::string_view payload);
  bool flush() { return unsent_.empty() || connection_.send_some(unsent_); }

  TcpConnection connection_;
  std::string host_, key_;
  Phase phase_ = Phase::kConnecting;
  std::string reason_;
  std::string response_;  // of the handshake
  std::string unsent_;
  protocols::WebSocketReader reader_;
};

}  // namespace mien::app
