// Datagrams to and from other programs and machines. Nothing here waits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mien::app {

// Of the kind that the operating system's functions take, kept as bytes; none: empty.
struct UdpAddress {
  std::string bytes;

  [[nodiscard]] bool loopback() const;
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] UdpAddress with_port(std::uint16_t port) const;
  bool operator==(const UdpAddress&) const = default;
};

struct Datagram {
  std::string bytes;  // as far as `most_bytes` reach
  UdpAddress from;
};

class UdpSocket {
 public:
  // Sends to this host. Throws Failure(kExitOutput), which begins with `what`, when there is none.
  static UdpSocket to(const std::string& host, std::uint16_t port, const std::string& what);
  // Is sent to at this address of ours, port 0 being any. Throws likewise.
  static UdpSocket at(const std::string& host, std::uint16_t port, const std::string& what);

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;
  ~UdpSocket();

  // False when it could not be sent at once.
  bool send(std::string_view packet) { return send(packet, peer_); }
  bool send(std::string_view packet, const UdpAddress& to);

  // The next that waits; a longer one is cut to `most_bytes`.
  std::optional<Datagram> receive(std::size_t most_bytes);

 private:
  UdpSocket(const std::string& host, std::uint16_t port, const std::string& what, bool bound);

  std::intptr_t handle_ = -1;
  UdpAddress peer_;
};

}  // namespace mien::app
