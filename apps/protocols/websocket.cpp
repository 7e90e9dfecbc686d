// Encodes and decodes WebSocket's handshake and frames.
#include "apps/protocols/websocket.h"

#include <utility>

#include "apps/animation/base64.h"
#include "apps/protocols/bytes.h"
#include "apps/protocols/http.h"
#include "apps/protocols/sha1.h"

namespace mien::protocols {
namespace {

constexpr std::string_view kAcceptSuffix = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
constexpr std::uint8_t kFinal = 0x80, kReserved = 0x70, kOpcode = 0x0f;  // first byte
constexpr std::uint8_t kMasked = 0x80, kLength = 0x7f;                   // second byte
constexpr std::uint8_t kLength16 = 126, kLength64 = 127;
constexpr std::size_t kMaxControlBytes = 125;

bool is_control(WebSocketOpcode opcode) { return opcode >= WebSocketOpcode::kClose; }

WebSocketHandshake refuse(std::string what, std::string& reason) {
  reason = std::move(what);
  return WebSocketHandshake::kRefused;
}

}  // namespace

std::string websocket_request(std::string_view host, std::string_view key) {
  return std::string("GET / HTTP/1.1\r\nHost: ")
      .append(host)
      .append("\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n")
      .append("Sec-WebSocket-Key: ")
      .append(animation::base64(key))
      .append("\r\n\r\n");
}

std::string websocket_accept(std::string_view key) {
  return animation::base64(sha1(animation::base64(key).append(kAcceptSuffix)));
}

WebSocketHandshake check_websocket_response(std::string_view bytes, std::string_view key,
                                            std::size_t& used_bytes, std::string& reason) {
  HttpResponse response;
  std::size_t used = 0;
  const HttpParse parsed = parse_http_response(bytes, response, used);
  if (parsed == HttpParse::kIncomplete) {
    return WebSocketHandshake::kIncomplete;
  }
  if (parsed != HttpParse::kOk) {
    return refuse("not an HTTP response", reason);
  }
  if (response.status != 101) {
    return refuse("HTTP status " + std::to_string(response.status) + " (expected 101)", reason);
  }
  if (http_lower_case(response.field("upgrade")) != "websocket" ||
      http_lower_case(response.field("connection")).find("upgrade") == std::string::npos ||
      response.field("sec-websocket-accept") != websocket_accept(key)) {
    return refuse("not a WebSocket server", reason);
  }
  if (!response.field("sec-websocket-extensions").empty() ||
      !response.field("sec-websocket-protocol").empty()) {
    return refuse("WebSocket extension or subprotocol that was not requested", reason);
  }
  used_bytes = used;
  return WebSocketHandshake::kOk;
}

std::string websocket_frame(WebSocketOpcode opcode, std::string_view payload,
                            const std::array<std::uint8_t, 4>& mask) {
  std::string frame;
  append_big(frame, static_cast<std::uint8_t>(kFinal | static_cast<std::uint8_t>(opcode)));
  if (payload.size() < kLength16) {
    append_big(frame, static_cast<std::uint8_t>(kMasked | payload.size()));
  } else if (payload.size() <= 0xffff) {
    append_big(frame, static_cast<std::uint8_t>(kMasked | kLength16));
    append_big(frame, static_cast<std::uint16_t>(payload.size()));
  } else {
    append_big(frame, static_cast<std::uint8_t>(kMasked | kLength64));
    append_big(frame, std::uint64_t{payload.size()});
  }
  for (const std::uint8_t byte : mask) {
    append_big(frame, byte);
  }
  for (std::size_t i = 0; i < payload.size(); ++i) {
    frame += static_cast<char>(static_cast<std::uint8_t>(payload[i]) ^ mask[i % mask.size()]);
  }
  return frame;
}

struct WebSocketReader::Frame {
  bool is_final = false;
  WebSocketOpcode opcode = WebSocketOpcode::kContinuation;
  std::uint64_t bytes = 0;  // of the payload
  std::string payload;
};

void WebSocketReader::append(std::string_view bytes) {
  if (error_.empty()) {
    bytes_ += bytes;
  }
}

bool WebSocketReader::fail(const char* what) {
  error_ = what;
  bytes_.clear();
  fragments_.reset();
  return false;
}

std::optional<WebSocketMessage> WebSocketReader::next() {
  Frame frame;
  while (error_.empty() && read_frame(frame)) {
    if (std::optional<WebSocketMessage> message = joined(frame)) {
      return message;
    }
  }
  return std::nullopt;
}

// Returns false if the frame is incomplete or invalid. The header is checked before the payload
// arrives, so that no limit is exceeded.
bool WebSocketReader::read_frame(Frame& frame) {
  if (bytes_.size() < 2) {
    return false;
  }
  const auto first = static_cast<std::uint8_t>(bytes_[0]);
  const auto second = static_cast<std::uint8_t>(bytes_[1]);
  frame.is_final = (first & kFinal) != 0;
  frame.opcode = static_cast<WebSocketOpcode>(first & kOpcode);
  if ((first & kReserved) != 0 || (second & kMasked) != 0) {
    return fail("invalid WebSocket frame: reserved bits or a mask");
  }
  std::size_t header_bytes = 2;
  frame.bytes = second & kLength;
  if (!read_length(frame, header_bytes) || !check(frame) ||
      bytes_.size() - header_bytes < frame.bytes) {
    return false;
  }
  const auto payload_bytes = static_cast<std::size_t>(frame.bytes);
  frame.payload = bytes_.substr(header_bytes, payload_bytes);
  bytes_.erase(0, header_bytes + payload_bytes);
  return true;
}

// Lengths from 126 on follow in 2 or 8 bytes.
bool WebSocketReader::read_length(Frame& frame, std::size_t& header_bytes) {
  const std::size_t length_bytes = frame.bytes == kLength16 ? 2 : frame.bytes == kLength64 ? 8 : 0;
  if (bytes_.size() < header_bytes + length_bytes) {
    return false;
  }
  if (length_bytes > 0) {
    frame.bytes = 0;
    for (std::size_t i = 0; i < length_bytes; ++i) {
      frame.bytes = frame.bytes << 8 | static_cast<std::uint8_t>(bytes_[header_bytes + i]);
    }
  }
  header_bytes += length_bytes;
  return true;
}

bool WebSocketReader::check(const Frame& frame) {
  switch (frame.opcode) {
    case WebSocketOpcode::kClose:
    case WebSocketOpcode::kPing:
    case WebSocketOpcode::kPong:
      return (frame.is_final && frame.bytes <= kMaxControlBytes) ||
             fail("invalid WebSocket frame: fragmented or long control frame");
    case WebSocketOpcode::kText:
    case WebSocketOpcode::kBinary:
    case WebSocketOpcode::kContinuation:
      break;
    default:
      return fail("invalid WebSocket frame: unknown opcode");
  }
  if ((frame.opcode == WebSocketOpcode::kContinuation) != fragments_.has_value()) {
    return fail("invalid WebSocket frame: wrong order of fragments");
  }
  const std::size_t before = fragments_ ? fragments_->payload.size() : 0;
  return frame.bytes <= kWebSocketMaxMessageBytes - before ||
         fail("WebSocket message larger than 1 MiB");
}

// Control frames may come between fragments.
std::optional<WebSocketMessage> WebSocketReader::joined(const Frame& frame) {
  if (is_control(frame.opcode) || (frame.is_final && !fragments_)) {
    return WebSocketMessage{frame.opcode, frame.payload};
  }
  if (!fragments_) {
    fragments_ = WebSocketMessage{frame.opcode, ""};
  }
  fragments_->payload += frame.payload;
  return frame.is_final ? std::exchange(fragments_, std::nullopt) : std::nullopt;
}

}  // namespace mien::protocols
