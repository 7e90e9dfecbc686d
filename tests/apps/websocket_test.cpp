// Tests of WebSocket's handshake and frames, and of VTube Studio's answers.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>

#include "apps/protocols/sha1.h"
#include "apps/protocols/vts.h"
#include "apps/protocols/websocket.h"

namespace mien::protocols {
namespace {

constexpr std::array<std::uint8_t, 4> kNoMask = {0, 0, 0, 0};
const std::string kKey = "the sample nonce";  // RFC 6455, section 1.3

std::string hex(const std::string& bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const char byte : bytes) {
    text += kDigits[static_cast<std::uint8_t>(byte) >> 4];
    text += kDigits[static_cast<std::uint8_t>(byte) & 15];
  }
  return text;
}

// The examples of FIPS 180-4, and lengths around that of a block.
TEST(Sha1, Examples) {
  EXPECT_EQ(hex(sha1("")), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
  EXPECT_EQ(hex(sha1("abc")), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hex(sha1("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  EXPECT_EQ(hex(sha1(std::string(55, 'a'))), "c1c8bbdc22796e28c0e15163d20899b65621d65a");
  EXPECT_EQ(hex(sha1(std::string(64, 'a'))), "0098ba824b5c16427bd7a1122a5a442a25ec644d");
}

std::string response(const std::string& accept, const std::string& more = "") {
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Accept: " +
         accept + "\r\n" + more + "\r\n";
}

TEST(WebSocket, HandshakeOfTheRfc) {
  EXPECT_EQ(websocket_request("server:8001", kKey),
            "GET / HTTP/1.1\r\nHost: server:8001\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_EQ(websocket_accept(kKey), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST(WebSocket, ChecksTheResponse) {
  const std::string good = response(websocket_accept(kKey));
  std::size_t used_bytes = 0;
  std::string reason;
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_EQ(check_websocket_response(good.substr(0, size), kKey, used_bytes, reason),
              WebSocketHandshake::kIncomplete);
  }
  EXPECT_EQ(check_websocket_response(good + "\x81", kKey, used_bytes, reason),
            WebSocketHandshake::kOk);
  EXPECT_EQ(used_bytes, good.size());
  for (const std::string& bad :
       {response("s3pPLMBiTxaQ9kYGzzhZRbK+xOO="), response(""),
        response(websocket_accept(kKey), "Sec-WebSocket-Extensions: x\r\n"),
        response(websocket_accept(kKey), "Sec-WebSocket-Protocol: x\r\n"),
        std::string("HTTP/1.1 200 OK\r\n\r\n"), std::string("HTTP/1.1 1x1 OK\r\n\r\n"),
        std::string("HTTP/2 101 OK\r\n\r\n"), std::string(9000, 'a')}) {
    reason.clear();
    EXPECT_EQ(check_websocket_response(bad, kKey, used_bytes, reason),
              WebSocketHandshake::kRefused);
    EXPECT_FALSE(reason.empty());
  }
}

// The masked "Hello" of RFC 6455, section 5.7.
TEST(WebSocket, WritesMaskedFrames) {
  EXPECT_EQ(hex(websocket_frame(WebSocketOpcode::kText, "Hello", {0x37, 0xfa, 0x21, 0x3d})),
            "818537fa213d7f9f4d5158");
  const auto head = [](std::size_t bytes) {
    const std::string payload(bytes, 'a');
    return hex(websocket_frame(WebSocketOpcode::kBinary, payload, kNoMask).substr(0, 10));
  };
  EXPECT_EQ(head(125), "82fd0000000061616161");
  EXPECT_EQ(head(126), "82fe007e000000006161");
  EXPECT_EQ(head(65535), "82feffff000000006161");
  EXPECT_EQ(head(65536), "82ff0000000000010000");
}

std::string frame(int first, const std::string& payload) {
  return std::string{static_cast<char>(first), static_cast<char>(payload.size())} + payload;
}

TEST(WebSocket, JoinsFragmentsAroundControlFrames) {
  const std::string bytes = frame(0x01, "Hel") + frame(0x89, "ping") + frame(0x00, "") +
                            frame(0x80, "lo") + frame(0x82, "x");
  WebSocketReader reader;
  std::string got;
  for (const char byte : bytes) {
    reader.append({&byte, 1});
    while (const std::optional<WebSocketMessage> message = reader.next()) {
      got += std::to_string(static_cast<int>(message->opcode)) + message->payload + ";";
    }
  }
  EXPECT_EQ(got, "9ping;1Hello;2x;");
  EXPECT_EQ(reader.error(), "");
}

std::string error_of(const std::string& bytes) {
  WebSocketReader reader;
  reader.append(bytes);
  while (reader.next()) {
  }
  const std::string error = reader.error();
  reader.append(frame(0x81, "after"));  // ignored
  EXPECT_EQ(error.empty(), reader.next().has_value());
  return error;
}

TEST(WebSocket, RejectsInvalidFrames) {
  EXPECT_EQ(error_of(frame(0x81, "good")), "");
  for (const int first : {0xc1, 0xa1, 0x91, 0x83, 0x8b, 0x8f, 0x80, 0x00, 0x08, 0x09, 0x0a}) {
    EXPECT_NE(error_of(frame(first, "x")), "") << first;
  }
  EXPECT_NE(error_of(frame(0x01, "a") + frame(0x01, "b")), "");
  EXPECT_NE(error_of(std::string("\x81\x80\0\0\0\0", 6)), "");  // masked
  EXPECT_NE(error_of(std::string("\x89\x7e\x00\x7e", 4)), "");  // a long ping
}

TEST(WebSocket, LimitsMessages) {
  const auto start = [](std::uint64_t bytes) {
    std::string head = "\x81\x7f";
    for (int shift = 56; shift >= 0; shift -= 8) {
      head += static_cast<char>(bytes >> shift & 0xff);
    }
    return head;
  };
  WebSocketReader reader;
  reader.append(start(kWebSocketMaxMessageBytes) + std::string(kWebSocketMaxMessageBytes, ' '));
  EXPECT_EQ(reader.next()->payload.size(), kWebSocketMaxMessageBytes);
  EXPECT_NE(error_of(start(kWebSocketMaxMessageBytes + 1)), "");
  EXPECT_NE(error_of(start(~std::uint64_t{0})), "");
  const std::string half = start(kWebSocketMaxMessageBytes / 2 + 1).substr(1) +
                           std::string(kWebSocketMaxMessageBytes / 2 + 1, ' ');
  EXPECT_NE(error_of('\x01' + half + '\x80' + half), "");
}

std::string answer(const std::string& type, const std::string& data) {
  return R"({"apiName":"VTubeStudioPublicAPI","requestID":"id","messageType":")" + type +
         R"(","data":)" + data + "}";
}

TEST(Vts, ParsesAnswers) {
  std::string fault;
  const auto parse = [&](const std::string& type, const std::string& data) {
    return parse_vts_answer(answer(type, data), fault).value();
  };
  EXPECT_EQ(parse("AuthenticationTokenResponse", R"({"authenticationToken":"a-1"})").token, "a-1");
  EXPECT_TRUE(parse("AuthenticationResponse", R"({"authenticated":true})").authenticated);
  const VtsAnswer rejected =
      parse("AuthenticationResponse", R"({"authenticated":false,"reason":"no"})");
  EXPECT_FALSE(rejected.authenticated);
  EXPECT_EQ(rejected.reason, "no");
  const VtsAnswer error = parse("APIError", R"({"errorID":50,"message":"denied"})");
  EXPECT_EQ(error.error, 50);
  EXPECT_EQ(error.reason, "denied");
  EXPECT_EQ(error.request, "id");
  EXPECT_EQ(parse("APIError", "3").reason, "");
  EXPECT_EQ(parse("ModelLoadedEvent", "{}").kind, VtsAnswerKind::kOther);
}

TEST(Vts, ShortensReasonsBetweenCharacters) {
  std::string long_text, fault;
  for (int i = 0; i < 150; ++i) {
    long_text += "\xc3\xa9";
  }
  const auto parsed =
      parse_vts_answer(answer("APIError", R"({"message":"x)" + long_text + "\"}"), fault);
  EXPECT_EQ(parsed->reason.size(), 199u);
}

TEST(Vts, RejectsOtherTexts) {
  std::string fault;
  for (const std::string& text :
       {std::string(""), std::string("{"), std::string("[]"), std::string(R"({"apiName":"x"})"),
        answer("AuthenticationTokenResponse", "{}"),
        answer("AuthenticationTokenResponse", R"({"authenticationToken":"a b"})"),
        answer("AuthenticationTokenResponse",
               R"({"authenticationToken":")" + std::string(65, 'a') + "\"}")}) {
    fault.clear();
    EXPECT_FALSE(parse_vts_answer(text, fault).has_value()) << text;
    EXPECT_FALSE(fault.empty());
  }
}

TEST(Vts, EscapesTokens) {
  EXPECT_NE(vts_authentication_request("a\"b\\").find(R"("authenticationToken":"a\"b\\")"),
            std::string::npos);
}

}  // namespace
}  // namespace mien::protocols
