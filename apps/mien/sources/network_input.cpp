// Restricts each URL to the network protocols that it needs.
#include "apps/mien/sources/network_input.h"

#include <array>
#include <string_view>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {
namespace {

struct Protocol {
  std::string_view name;
  std::string_view needs;  // ffmpeg's names of this and the underlying protocols
};

constexpr std::array<Protocol, 11> kProtocols = {{
    {"http", "http,tcp,httpproxy,crypto"},
    {"https", "https,http,tls,tcp,httpproxy,crypto"},
    {"rtsp", "rtsp,rtp,udp,tcp,http"},
    {"rtsps", "rtsps,rtsp,rtp,srtp,udp,tcp,tls"},
    {"rtp", "rtp,udp"},
    {"udp", "udp"},
    {"tcp", "tcp"},
    {"srt", "srt"},
    {"rtmp", "rtmp,tcp"},
    {"rtmps", "rtmps,rtmp,tls,tcp"},
    {"mmsh", "mmsh,http,tcp"},
}};

std::string_view scheme_of(std::string_view input) {
  const std::size_t end = input.find("://");
  const std::string_view scheme = input.substr(0, end == std::string_view::npos ? 0 : end);
  return scheme.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string_view::npos
             ? scheme
             : std::string_view();
}

}  // namespace

bool is_url(const std::string& input) { return !scheme_of(input).empty(); }

std::vector<std::string> input_arguments(const std::string& input) {
  const std::string_view scheme = scheme_of(input);
  if (scheme.empty()) {
    return {"-protocol_whitelist", "file,pipe", "-i", "file:" + input};
  }
  std::string known;
  for (const Protocol& protocol : kProtocols) {
    if (protocol.name == scheme) {
      return {"-protocol_whitelist", std::string(protocol.needs), "-i", input};
    }
    known.append(known.empty() ? "" : ", ").append(protocol.name);
  }
  throw Failure(kExitUsage, input + ": unknown protocol '" + std::string(scheme) +
                                "', supported protocols are " + known);
}

std::chrono::milliseconds timeout_of(const std::string& input) {
  return is_url(input) ? Subprocess::kNoTimeout : Subprocess::kTimeout;
}

}  // namespace mien::app
