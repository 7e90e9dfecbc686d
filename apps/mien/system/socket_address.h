// Addresses of sockets.
#pragma once

#include <cstdint>
#include <string>

namespace mien::app {

// The operating system's socket address as bytes; empty: no address.
struct SocketAddress {
  std::string bytes;

  // Looks up a name, which may take seconds. Throws Failure(kExitOutput) with the prefix `what` if
  // the host is unknown.
  static SocketAddress of(const std::string& host, std::uint16_t port, const std::string& what);

  [[nodiscard]] int family() const;
  [[nodiscard]] bool loopback() const;
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] SocketAddress with_port(std::uint16_t port) const;
  bool operator==(const SocketAddress&) const = default;
};

}  // namespace mien::app
