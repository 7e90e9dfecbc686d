// Connects to WebSocket servers.
#include "apps/mien/senders/websocket_client.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <random>
#include <utility>

namespace mien::app {
namespace {

using protocols::WebSocketOpcode;

constexpr std::chrono::milliseconds kAtOnce{0};
constexpr std::size_t kReadBytes = 16384;
constexpr int kMaxReads = 16;                     // per update
constexpr std::size_t kMaxUnsentBytes = 1 << 16;  // with more, pings are not answered

// The operating system's random numbers.
template <std::size_t count>
std::array<std::uint8_t, count> random_bytes() {
  std::random_device device;
  std::array<std::uint8_t, count> bytes;
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(device());
  }
  return bytes;
}

}  // namespace

WebSocketClient::WebSocketClient(const SocketAddress& server, std::string host)
    : connection_(server), host_(std::move(host)) {
  const auto key = random_bytes<protocols::kWebSocketKeyBytes>();
  key_.assign(key.begin(), key.end());
}

WebSocketClient::~WebSocketClient() {
  if (is_open()) {
    constexpr std::string_view kGoingAway = "\x03\xe9";  // status 1001
    enqueue(WebSocketOpcode::kClose, kGoingAway);
  }
}

bool WebSocketClient::end(std::string reason) {
  phase_ = Phase::kClosed;
  reason_ = std::move(reason);
  return false;
}

bool WebSocketClient::update() {
  if (phase_ == Phase::kConnecting && !check_connected()) {
    return phase_ != Phase::kClosed;
  }
  if (phase_ == Phase::kClosed) {
    return false;
  }
  if (!flush()) {
    return end("connection lost");
  }
  const bool received = receive_bytes();  // check what came before the end
  if (phase_ == Phase::kHandshake && !check_response()) {
    return false;
  }
  return received || end("connection closed by the server");
}

// Returns true in the moment the connection exists.
bool WebSocketClient::check_connected() {
  std::string reason;
  switch (connection_.connected(reason)) {
    case TcpConnection::Connected::kYes:
      phase_ = Phase::kHandshake;
      unsent_ = protocols::websocket_request(host_, key_);
      return true;
    case TcpConnection::Connected::kFailed:
      return end(reason);
    case TcpConnection::Connected::kNotYet:
      break;
  }
  return false;
}

// Returns false if the server has closed. Messages that came before can still be received.
bool WebSocketClient::receive_bytes() {
  for (int i = 0; i < kMaxReads; ++i) {
    std::string bytes;
    const auto received = connection_.receive(bytes, kReadBytes, kAtOnce);
    if (phase_ == Phase::kHandshake) {
      response_ += bytes;
    } else {
      reader_.append(bytes);
    }
    if (received != TcpConnection::Received::kBytes) {
      return received == TcpConnection::Received::kNothing;
    }
  }
  return true;
}

bool WebSocketClient::check_response() {
  std::size_t used_bytes = 0;
  std::string reason;
  switch (protocols::check_websocket_response(response_, key_, used_bytes, reason)) {
    case protocols::WebSocketHandshake::kRefused:
      return end(reason);
    case protocols::WebSocketHandshake::kOk:
      phase_ = Phase::kOpen;
      reader_.append(std::string_view(response_).substr(used_bytes));
      response_.clear();
      break;
    case protocols::WebSocketHandshake::kIncomplete:
      break;
  }
  return true;
}

std::optional<std::string> WebSocketClient::receive() {
  while (std::optional<protocols::WebSocketMessage> message = reader_.next()) {
    if (message->opcode == WebSocketOpcode::kText) {
      return std::move(message->payload);
    }
    if (message->opcode == WebSocketOpcode::kPing && unsent_.size() < kMaxUnsentBytes) {
      enqueue(WebSocketOpcode::kPong, message->payload);
    } else if (message->opcode == WebSocketOpcode::kClose) {
      enqueue(WebSocketOpcode::kClose, message->payload);
      end("connection closed by the server");
    } else if (message->opcode == WebSocketOpcode::kBinary) {
      end("binary message (expected text)");
    }
  }
  if (!reader_.error().empty()) {
    end(reader_.error());
  }
  return std::nullopt;
}

void WebSocketClient::send(std::string_view text) { enqueue(WebSocketOpcode::kText, text); }

void WebSocketClient::enqueue(WebSocketOpcode opcode, std::string_view payload) {
  unsent_ += protocols::websocket_frame(opcode, payload, random_bytes<4>());
  flush();  // a failure is found by the next update
}

}  // namespace mien::app
