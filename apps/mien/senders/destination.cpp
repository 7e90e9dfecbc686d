// Parses the URLs of --send.
#include "apps/mien/senders/destination.h"

#include <charconv>
#include <string_view>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

std::string unescaped(std::string_view text, const Destination& destination) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    unsigned char byte = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || parsed.ptr != digits.data() + 2 || byte == 0) {
      destination.fail("expected two hexadecimal digits after '%'");
    }
    result += static_cast<char>(byte);
    i += 2;
  }
  return result;
}

void read_options(std::string_view query, Destination& destination) {
  while (!query.empty()) {
    const std::string_view option = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), option.size() + 1));
    const std::size_t equals = option.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      destination.fail(std::string(option) + ": expected NAME=VALUE");
    }
    const std::string name(option.substr(0, equals));
    if (!destination.options.emplace(name, unescaped(option.substr(equals + 1), destination))
             .second) {
      destination.fail("duplicate option '" + name + "'");
    }
  }
}

void read_place(std::string_view place, Destination& destination) {
  std::size_t colon = place.rfind(':');
  if (place.starts_with('[')) {
    const std::size_t end = place.find(']');
    if (end == std::string_view::npos || (end + 1 < place.size() && place[end + 1] != ':')) {
      destination.fail("expected an address in '[' and ']'");
    }
    destination.host = place.substr(1, end - 1);
    colon = end + 1 < place.size() ? end + 1 : std::string_view::npos;
  } else {
    destination.host = place.substr(0, colon);
    if (destination.host.find(':') != std::string::npos) {
      destination.fail("expected an IPv6 address in '[' and ']'");
    }
  }
  if (colon != std::string_view::npos) {
    destination.port = parse_port(std::string(place.substr(colon + 1)), destination);
  }
}

}  // namespace

std::string Destination::take(const std::string& option, const std::string& default_value) {
  const auto found = options.extract(option);
  return found.empty() ? default_value : found.mapped();
}

void Destination::require_all_taken() const {
  if (!options.empty()) {
    fail("unknown option '" + options.begin()->first + "' for " + scheme);
  }
}

void Destination::fail(const std::string& what) const {
  throw Failure(kExitUsage, "--send " + text + ": " + what);
}

Destination parse_destination(const std::string& text) {
  Destination destination;
  destination.text = text;
  const std::size_t slashes = text.find("://");
  if (slashes == std::string::npos) {
    destination.fail("expected a URL such as vmc://127.0.0.1:39539");
  }
  destination.scheme = text.substr(0, slashes);
  std::string_view rest = std::string_view(text).substr(slashes + 3);
  const std::size_t question = rest.find('?');
  if (question != std::string_view::npos) {
    read_options(rest.substr(question + 1), destination);
    rest = rest.substr(0, question);
  }
  if (rest.ends_with('/')) {
    rest.remove_suffix(1);
  }
  read_place(rest, destination);
  return destination;
}

std::uint16_t parse_port(const std::string& digits, const Destination& destination) {
  std::uint16_t port = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (parsed.ec != std::errc() || parsed.ptr != digits.data() + digits.size() || port == 0) {
    destination.fail("invalid port (got '" + digits + "', expected 1 to 65535)");
  }
  return port;
}

}  // namespace mien::app
