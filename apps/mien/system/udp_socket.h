// UDP sockets. No function waits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "apps/mien/system/socket_address.h"

namespace mien::app {

struct Datagram {
  std::string bytes;  // truncated to `max_bytes`
  SocketAddress from;
};

class UdpSocket {
 public:
  // Opens a socket that sends to a host. Throws Failure(kExitOutput) with the prefix `what` if the
  // host is unknown.
  static UdpSocket to(const std::string& host, std::uint16_t port, const std::string& what);
  // Opens a socket that receives at a local address; port 0 selects a free one. Throws likewise.
  static UdpSocket at(const std::string& host, std::uint16_t port, const std::string& what);

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;
  ~UdpSocket();

  // Returns false if the packet could not be sent at once.
  bool send(std::string_view packet) { return send(packet, peer_); }
  bool send(std::string_view packet, const SocketAddress& to);

  // Returns the next received packet, truncated to `max_bytes`.
  std::optional<Datagram> receive(std::size_t max_bytes);

 private:
  UdpSocket(const std::string& host, std::uint16_t port, const std::string& what, bool bound);

  std::intptr_t handle_ = -1;
  SocketAddress peer_;
};

}  // namespace mien::app
