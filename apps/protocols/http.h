// HTTP/1.1 (RFC 9112) as a small server on this machine and the handshake of WebSocket need it:
// requests with an optional body of known length, and responses.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mien::protocols {

inline constexpr std::size_t kHttpMaxHeadBytes = 8192;   // request line and fields
inline constexpr std::size_t kHttpMaxBodyBytes = 16384;  // body of a request
inline constexpr std::size_t kHttpMaxFields = 64;

struct HttpFields {
  std::vector<std::pair<std::string, std::string>> fields;  // names in lower case

  // The value of a field, given in lower case; empty if it is absent.
  [[nodiscard]] std::string_view field(std::string_view name) const;
};

struct HttpRequest : HttpFields {
  std::string method;  // "GET"
  std::string target;  // "/path?query", as received
  std::string body;
  bool keep_alive = true;
};

struct HttpResponse : HttpFields {
  int status = 0;
};

// The result of parsing. Values from 400 on are the status of the response.
enum class HttpParse : int {
  kIncomplete = 0,
  kOk = 200,
  kMalformed = 400,
  kBodyTooLarge = 413,
  kHeadTooLarge = 431,
  kUnsupported = 501,  // a transfer coding
  kVersion = 505,
};

// Parses the request at the start of `bytes`, which holds everything received so far. Sets
// `request` and `used_bytes` only if it returns kOk. Rejects what servers and proxies could read
// differently: bare line feeds, folded fields, repeated Host or Content-Length.
[[nodiscard]] HttpParse parse_http_request(std::string_view bytes, HttpRequest& request,
                                           std::size_t& used_bytes);

// The same for a response, without its body.
[[nodiscard]] HttpParse parse_http_response(std::string_view bytes, HttpResponse& response,
                                            std::size_t& used_bytes);

[[nodiscard]] std::string http_lower_case(std::string_view text);

struct HttpField {
  std::string_view name, value;
};

// The status line and the fields of a response, up to the empty line.
[[nodiscard]] std::string http_head(int status, std::initializer_list<HttpField> fields);

// A complete response with Content-Length.
[[nodiscard]] std::string http_response(int status, std::string_view type, std::string_view body,
                                        std::initializer_list<HttpField> fields = {});

}  // namespace mien::protocols
