// The bytes are what a server sends to the sender of VTube Studio: its response to the handshake,
// if it begins like one, and frames. Messages must not depend on how the bytes are divided, and
// must keep the limits.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/protocols/vts.h"
#include "apps/protocols/websocket.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"

namespace {

using mien::fuzz::require;
namespace protocols = mien::protocols;
using protocols::WebSocketHandshake;
using protocols::WebSocketOpcode;

constexpr std::string_view kKey = "the sample nonce";

struct Messages {
  std::vector<protocols::WebSocketMessage> list;
  std::string error;
};

Messages messages_of(std::string_view bytes, std::size_t part_bytes) {
  protocols::WebSocketReader reader;
  Messages messages;
  while (!bytes.empty()) {
    reader.append(bytes.substr(0, part_bytes));
    bytes.remove_prefix(std::min(bytes.size(), part_bytes));
    while (std::optional<protocols::WebSocketMessage> message = reader.next()) {
      messages.list.push_back(*message);
    }
  }
  messages.error = reader.error();
  return messages;
}

void check_answer(const std::string& text) {
  std::string fault;
  const std::optional<protocols::VtsAnswer> answer = protocols::parse_vts_answer(text, fault);
  require(answer.has_value() == fault.empty());
  if (answer) {
    require(answer->request.size() <= 200 && answer->reason.size() <= 200);
    require((answer->kind == protocols::VtsAnswerKind::kToken) ==
            protocols::is_vts_token(answer->token));
  }
}

void check(const protocols::WebSocketMessage& message) {
  require(message.opcode != WebSocketOpcode::kContinuation);
  require(message.payload.size() <= protocols::kWebSocketMaxMessageBytes);
  require(message.opcode < WebSocketOpcode::kClose || message.payload.size() <= 125);
  if (message.opcode == WebSocketOpcode::kText) {
    check_answer(message.payload);
  }
}

// The bytes after the response.
std::string_view after_handshake(std::string_view bytes) {
  std::size_t used_bytes = 0;
  std::string reason;
  const WebSocketHandshake result =
      protocols::check_websocket_response(bytes, kKey, used_bytes, reason);
  require((result == WebSocketHandshake::kRefused) == !reason.empty());
  require((result == WebSocketHandshake::kOk) == (used_bytes > 0) && used_bytes <= bytes.size());
  return bytes.substr(used_bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check_answer(std::string(bytes));
  const std::string_view frames = after_handshake(bytes);
  const Messages whole = messages_of(frames, frames.size());
  const Messages parts = messages_of(frames, 3);
  require(whole.list.size() == parts.list.size() && whole.error == parts.error);
  for (std::size_t i = 0; i < whole.list.size(); ++i) {
    require(whole.list[i].opcode == parts.list[i].opcode);
    require(whole.list[i].payload == parts.list[i].payload);
    check(whole.list[i]);
  }
  return 0;
}
