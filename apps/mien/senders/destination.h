// Where to send to, as people write it: "vmc://192.168.0.5:39540?names=camel".
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace mien::app {

struct Destination {
  std::string text;        // as it was written
  std::string scheme;      // "vmc"
  std::string host;        // empty where none is named
  std::uint16_t port = 0;  // 0 where none is named
  std::map<std::string, std::string> options;

  // Takes an option out; `otherwise` where it is not there.
  std::string take(const std::string& option, const std::string& otherwise);
  // Throws Failure(kExitUsage) if there are options that nobody took.
  void require_all_taken() const;
  [[noreturn]] void fail(const std::string& what) const;
};

// Throws Failure(kExitUsage) that says what of it cannot be understood. Brackets go around the
// address of IPv6; %XX in an option's value is a byte.
Destination parse_destination(const std::string& text);

// A port number. Throws as above.
std::uint16_t parse_port(const std::string& digits, const Destination& destination);

}  // namespace mien::app
