// The bytes are what a client of the page sends. Requests must not depend on how the bytes are
// divided, and must keep the limits.
#include <string>
#include <string_view>

#include "apps/protocols/http.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"

namespace {

using mien::fuzz::require;
namespace protocols = mien::protocols;
using protocols::HttpParse;

void check(const protocols::HttpRequest& request) {
  require(request.target.starts_with('/') && request.target.find(' ') == std::string::npos);
  require(!request.field("host").empty() || request.fields.size() > 0);
  require(request.fields.size() <= protocols::kHttpMaxFields);
  require(request.body.size() <= protocols::kHttpMaxBodyBytes);
  for (const auto& [name, value] : request.fields) {
    require(!name.empty() && name.find_first_of(" \t\r\n:") == std::string::npos);
    require(value.find_first_of("\r\n") == std::string::npos);
  }
}

// The result of the first prefix that is not incomplete.
HttpParse parse_by_prefixes(std::string_view text, std::size_t& used_bytes) {
  protocols::HttpRequest request;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const HttpParse parsed = parse_http_request(text.substr(0, size), request, used_bytes);
    if (parsed != HttpParse::kIncomplete) {
      return parsed;
    }
  }
  return HttpParse::kIncomplete;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  while (!text.empty()) {
    protocols::HttpRequest request;
    std::size_t used_bytes = 0, used_of_prefix = 0;
    const HttpParse parsed = parse_http_request(text, request, used_bytes);
    if (size < 1024) {  // quadratic
      require(parse_by_prefixes(text, used_of_prefix) == parsed);
      require(used_of_prefix == used_bytes);
    }
    if (parsed != HttpParse::kOk) {
      require(used_bytes == 0 && request.target.empty());
      break;
    }
    check(request);
    require(used_bytes > 0 && used_bytes <= text.size());
    text.remove_prefix(used_bytes);
  }
  return 0;
}
