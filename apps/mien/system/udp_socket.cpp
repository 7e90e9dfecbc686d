// UDP sockets on both families of systems.
#include "apps/mien/system/udp_socket.h"

#include "apps/mien/system/failure.h"
#include "apps/mien/system/socket_calls.h"

namespace mien::app {
namespace {

SocketAddress packed(const sockaddr_storage& address, socklen_t bytes) {
  return {std::string(reinterpret_cast<const char*>(&address), bytes)};
}

}  // namespace

UdpSocket UdpSocket::to(const std::string& host, std::uint16_t port, const std::string& what) {
  return {host, port, what, false};
}

UdpSocket UdpSocket::at(const std::string& host, std::uint16_t port, const std::string& what) {
  return {host, port, what, true};
}

UdpSocket::UdpSocket(const std::string& host, std::uint16_t port, const std::string& what,
                     bool bound)
    : peer_(SocketAddress::of(host, port, what)) {
  const auto handle = ::socket(peer_.family(), SOCK_DGRAM, 0);
  handle_ = static_cast<std::intptr_t>(handle);
  const sockaddr_storage address = sockets::storage(peer_);
  if (handle_ < 0 || (bound && ::bind(handle, reinterpret_cast<const sockaddr*>(&address),
                                      static_cast<socklen_t>(peer_.bytes.size())) != 0)) {
    const std::string reason = sockets::last_error();
    if (handle_ >= 0) {
      sockets::close(handle);
    }
    throw Failure(kExitOutput, what + ": cannot bind port " + std::to_string(port) + " of '" +
                                   host + "': " + reason);
  }
  sockets::prepare(handle);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : handle_(other.handle_), peer_(std::move(other.peer_)) {
  other.handle_ = -1;
}

UdpSocket::~UdpSocket() {
  if (handle_ >= 0) {
    sockets::close(static_cast<sockets::Handle>(handle_));
  }
}

bool UdpSocket::send(std::string_view packet, const SocketAddress& to) {
  const sockaddr_storage address = sockets::storage(to);
  return ::sendto(static_cast<sockets::Handle>(handle_), packet.data(),
                  static_cast<sockets::Length>(packet.size()), 0,
                  reinterpret_cast<const sockaddr*>(&address),
                  static_cast<socklen_t>(to.bytes.size())) ==
         static_cast<std::make_signed_t<sockets::Length>>(packet.size());
}

std::optional<Datagram> UdpSocket::receive(std::size_t max_bytes) {
  std::string bytes(max_bytes, '\0');
  sockaddr_storage from = {};
  socklen_t length = sizeof from;
  const auto got = ::recvfrom(static_cast<sockets::Handle>(handle_), bytes.data(),
                              static_cast<sockets::Length>(bytes.size()), 0,
                              reinterpret_cast<sockaddr*>(&from), &length);
  if (got < 0) {
    return std::nullopt;
  }
  bytes.resize(static_cast<std::size_t>(got));
  return Datagram{std::move(bytes), packed(from, length)};
}

}  // namespace mien::app
