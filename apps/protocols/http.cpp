// Parses HTTP requests and responses, and writes responses.
#include "apps/protocols/http.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

namespace mien::protocols {
namespace {

constexpr std::string_view kLineEnd = "\r\n";
constexpr std::string_view kHeadEnd = "\r\n\r\n";

struct Status {
  int code;
  std::string_view reason;
};

constexpr Status kStatuses[] = {{200, "OK"},
                                {204, "No Content"},
                                {400, "Bad Request"},
                                {403, "Forbidden"},
                                {404, "Not Found"},
                                {405, "Method Not Allowed"},
                                {408, "Request Timeout"},
                                {413, "Content Too Large"},
                                {415, "Unsupported Media Type"},
                                {431, "Request Header Fields Too Large"},
                                {501, "Not Implemented"},
                                {503, "Service Unavailable"},
                                {505, "HTTP Version Not Supported"}};

bool is_token_character(char c) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kMarks.find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_character);
}

bool is_printable_ascii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

// Visible characters, spaces and tabs; bytes from 0x80 on are opaque.
bool is_field_value(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t') || byte == 0x7f;
  });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = text.find_first_not_of(kBlank);
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// "GET /path HTTP/1.1"
HttpParse read_first_line(std::string_view line, HttpRequest& request) {
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) {
    return HttpParse::kMalformed;
  }
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (!is_token(line.substr(0, first)) || !target.starts_with('/') || !is_printable_ascii(target) ||
      !version.starts_with("HTTP/")) {
    return HttpParse::kMalformed;
  }
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    return HttpParse::kVersion;
  }
  request.method = line.substr(0, first);
  request.target = target;
  request.keep_alive = version == "HTTP/1.1";
  return HttpParse::kOk;
}

// "Name: value"
HttpParse read_field(std::string_view line, HttpFields& head) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon)) ||
      !is_field_value(line.substr(colon + 1))) {
    return HttpParse::kMalformed;
  }
  if (head.fields.size() == kHttpMaxFields) {
    return HttpParse::kHeadTooLarge;
  }
  head.fields.emplace_back(http_lower_case(line.substr(0, colon)), trimmed(line.substr(colon + 1)));
  return HttpParse::kOk;
}

// "HTTP/1.1 200 OK"
HttpParse read_first_line(std::string_view line, HttpResponse& response) {
  constexpr std::string_view kVersion = "HTTP/1.1 ";
  if (!line.starts_with(kVersion)) {
    return HttpParse::kMalformed;
  }
  const std::string_view digits = line.substr(kVersion.size(), 3);
  const auto parsed =
      std::from_chars(digits.data(), digits.data() + digits.size(), response.status);
  return parsed.ptr == digits.data() + 3 && response.status >= 100 ? HttpParse::kOk
                                                                   : HttpParse::kMalformed;
}

template <class Head>
HttpParse read_head(std::string_view text, Head& head) {
  bool is_first = true;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find(kLineEnd));
    text.remove_prefix(std::min(text.size(), line.size() + kLineEnd.size()));
    const HttpParse parsed = is_first ? read_first_line(line, head) : read_field(line, head);
    if (parsed != HttpParse::kOk) {
      return parsed;
    }
    is_first = false;
  }
  return is_first ? HttpParse::kMalformed : HttpParse::kOk;
}

std::size_t head_end(std::string_view bytes) {
  return bytes.substr(0, kHttpMaxHeadBytes).find(kHeadEnd);
}

HttpParse without_end(std::string_view bytes) {
  return bytes.size() < kHttpMaxHeadBytes ? HttpParse::kIncomplete : HttpParse::kHeadTooLarge;
}

std::ptrdiff_t occurrences(const HttpRequest& request, std::string_view name) {
  return std::count_if(request.fields.begin(), request.fields.end(),
                       [name](const auto& field) { return field.first == name; });
}

// The length of the body, or nothing if it is not a number.
std::optional<std::uint64_t> body_bytes(const HttpRequest& request) {
  if (occurrences(request, "content-length") == 0) {
    return 0;
  }
  const std::string_view digits = request.field("content-length");
  std::uint64_t bytes = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), bytes);
  const bool whole = !digits.empty() && parsed.ptr == digits.data() + digits.size();
  return whole && parsed.ec == std::errc() ? std::optional(bytes) : std::nullopt;
}

// Checks the fields that frame the message and sets the length of its body.
HttpParse check_fields(HttpRequest& request, std::size_t& bytes) {
  if (occurrences(request, "transfer-encoding") > 0) {
    return HttpParse::kUnsupported;
  }
  const std::optional<std::uint64_t> length = body_bytes(request);
  if (occurrences(request, "host") != 1 || occurrences(request, "content-length") > 1 || !length) {
    return HttpParse::kMalformed;
  }
  if (*length > kHttpMaxBodyBytes) {
    return HttpParse::kBodyTooLarge;
  }
  bytes = static_cast<std::size_t>(*length);
  const std::string connection = http_lower_case(request.field("connection"));
  request.keep_alive = request.keep_alive && connection.find("close") == std::string::npos;
  return HttpParse::kOk;
}

}  // namespace

std::string http_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return lower;
}

std::string_view HttpFields::field(std::string_view name) const {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [name](const auto& field) { return field.first == name; });
  return found == fields.end() ? std::string_view() : std::string_view(found->second);
}

HttpParse parse_http_request(std::string_view bytes, HttpRequest& request,
                             std::size_t& used_bytes) {
  const std::size_t end = head_end(bytes);
  if (end == std::string_view::npos) {
    return without_end(bytes);
  }
  HttpRequest parsed;
  std::size_t length = 0;
  HttpParse result = read_head(bytes.substr(0, end), parsed);
  if (result == HttpParse::kOk) {
    result = check_fields(parsed, length);
  }
  const std::string_view rest = bytes.substr(end + kHeadEnd.size());
  if (result != HttpParse::kOk || rest.size() < length) {
    return result == HttpParse::kOk ? HttpParse::kIncomplete : result;
  }
  parsed.body = rest.substr(0, length);
  request = std::move(parsed);
  used_bytes = end + kHeadEnd.size() + length;
  return HttpParse::kOk;
}

HttpParse parse_http_response(std::string_view bytes, HttpResponse& response,
                              std::size_t& used_bytes) {
  const std::size_t end = head_end(bytes);
  if (end == std::string_view::npos) {
    return without_end(bytes);
  }
  HttpResponse parsed;
  const HttpParse result = read_head(bytes.substr(0, end), parsed);
  if (result == HttpParse::kOk) {
    response = std::move(parsed);
    used_bytes = end + kHeadEnd.size();
  }
  return result;
}

std::string http_head(int status, std::initializer_list<HttpField> fields) {
  std::string head = "HTTP/1.1 " + std::to_string(status);
  for (const Status& known : kStatuses) {
    if (known.code == status) {
      head.append(" ").append(known.reason);
    }
  }
  head += kLineEnd;
  for (const HttpField& field : fields) {
    head.append(field.name).append(": ").append(field.value).append(kLineEnd);
  }
  return head;
}

std::string http_response(int status, std::string_view type, std::string_view body,
                          std::initializer_list<HttpField> fields) {
  std::string response = http_head(status, fields);
  if (!type.empty()) {
    response.append("Content-Type: ").append(type).append(kLineEnd);
  }
  if (status != 204) {
    response.append("Content-Length: ").append(std::to_string(body.size())).append(kLineEnd);
  }
  return response.append(kLineEnd).append(body);
}

}  // namespace mien::protocols
