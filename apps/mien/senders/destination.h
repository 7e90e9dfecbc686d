// Destinations of --send: "vmc://192.168.0.5:39540?names=camel".
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace mien::app {

inline constexpr const char* kThisMachine = "127.0.0.1";  // the default of a host

struct Destination {
  std::string text;        // the URL
  std::string scheme;      // "vmc"
  std::string host;        // empty if not specified
  std::uint16_t port = 0;  // 0 if not specified
  std::map<std::string, std::string> options;

  // Removes and returns an option, or returns `default_value` if it is absent.
  std::string take(const std::string& option, const std::string& default_value);
  // Throws Failure(kExitUsage) if unknown options remain.
  void require_all_taken() const;
  [[noreturn]] void fail(const std::string& what) const;
};

// Parses a URL. IPv6 addresses are in brackets; %XX in an option's value is a byte. Throws
// Failure(kExitUsage) with the reason.
Destination parse_destination(const std::string& text);

// Parses a port number. Throws Failure(kExitUsage).
std::uint16_t parse_port(const std::string& digits, const Destination& destination);

}  // namespace mien::app
