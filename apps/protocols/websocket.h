// WebSocket (RFC 6455) in the role of the client, version 13, without extensions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mien::protocols {

inline constexpr std::size_t kWebSocketKeyBytes = 16;
inline constexpr std::size_t kWebSocketMaxMessageBytes = std::size_t{1} << 20;

// The request that opens a connection. `key`: kWebSocketKeyBytes random bytes.
[[nodiscard]] std::string websocket_request(std::string_view host, std::string_view key);

// The value of Sec-WebSocket-Accept that answers the key.
[[nodiscard]] std::string websocket_accept(std::string_view key);

enum class WebSocketHandshake : std::uint8_t { kIncomplete, kOk, kRefused };

// Checks the response at the start of `bytes`, which holds everything received so far. Sets
// `used_bytes` if it returns kOk, and `reason` if it returns kRefused.
[[nodiscard]] WebSocketHandshake check_websocket_response(std::string_view bytes,
                                                          std::string_view key,
                                                          std::size_t& used_bytes,
                                                          std::string& reason);

enum class WebSocketOpcode : std::uint8_t {
  kContinuation = 0,
  kText = 1,
  kBinary = 2,
  kClose = 8,
  kPing = 9,
  kPong = 10,
};

// A whole message in one masked frame. The mask must be unpredictable.
[[nodiscard]] std::string websocket_frame(WebSocketOpcode opcode, std::string_view payload,
                                          const std::array<std::uint8_t, 4>& mask);

struct WebSocketMessage {
  WebSocketOpcode opcode;  // not kContinuation
  std::string payload;
};

// Joins the frames of a server to messages. After an error, which is a violation of the protocol or
// of the limit, it returns no more messages, and the connection must be closed.
class WebSocketReader {
 public:
  void append(std::string_view bytes);
  // The next message, or nothing until more bytes arrive.
  [[nodiscard]] std::optional<WebSocketMessage> next();
  [[nodiscard]] const std::string& error() const { return error_; }  // empty: none

 private:
  struct Frame;

  [[nodiscard]] bool read_frame(Frame& frame);
  [[nodiscard]] bool read_length(Frame& frame, std::size_t& header_bytes);
  [[nodiscard]] bool check(const Frame& frame);
  [[nodiscard]] std::optional<WebSocketMessage> joined(const Frame& frame);
  bool fail(const char* what);

  std::string bytes_;  // not yet parsed
  std::optional<WebSocketMessage> fragments_;
  std::string error_;
};

}  // namespace mien::protocols
