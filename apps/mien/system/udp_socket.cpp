// UDP sockets on both families of systems.
#include "apps/mien/system/udp_socket.h"

#include <cstring>
#include <memory>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/socket_calls.h"

namespace mien::app {
namespace {

struct FreeAddresses {
  void operator()(addrinfo* found) const { freeaddrinfo(found); }
};

sockaddr_storage storage(const UdpAddress& address) {
  sockaddr_storage result = {};
  std::memcpy(&result, address.bytes.data(), address.bytes.size());
  return result;
}

UdpAddress packed(const sockaddr_storage& address, socklen_t bytes) {
  return {std::string(reinterpret_cast<const char*>(&address), bytes)};
}

}  // namespace

const addrinfo& sockets::preferred(const addrinfo& found) {
  for (const addrinfo* address = &found; address != nullptr; address = address->ai_next) {
    if (address->ai_family == AF_INET) {
      return *address;
    }
  }
  return found;
}

bool UdpAddress::loopback() const {
  const sockaddr_storage address = storage(*this);
  if (address.ss_family == AF_INET6) {
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr) != 0;
  }
  const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
  return ntohl(v4.sin_addr.s_addr) >> 24 == 127;
}

std::uint16_t UdpAddress::port() const {
  const sockaddr_storage address = storage(*this);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

UdpAddress UdpAddress::with_port(std::uint16_t port) const {
  sockaddr_storage address = storage(*this);
  (address.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(address).sin6_port
                                 : reinterpret_cast<sockaddr_in&>(address).sin_port) = htons(port);
  return packed(address, static_cast<socklen_t>(bytes.size()));
}

UdpSocket UdpSocket::to(const std::string& host, std::uint16_t port, const std::string& what) {
  return {host, port, what, false};
}

UdpSocket UdpSocket::at(const std::string& host, std::uint16_t port, const std::string& what) {
  return {host, port, what, true};
}

UdpSocket::UdpSocket(const std::string& host, std::uint16_t port, const std::string& what,
                     bool bound) {
  sockets::start();
  addrinfo hints = {};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    throw Failure(kExitOutput,
                  what + ": unknown host '" + host + "': " + sockets::name_error(error));
  }
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  const addrinfo& address = sockets::preferred(*found);
  peer_.bytes.assign(reinterpret_cast<const char*>(address.ai_addr), address.ai_addrlen);
  const auto handle = ::socket(address.ai_family, SOCK_DGRAM, 0);
  handle_ = static_cast<std::intptr_t>(handle);
  if (handle_ < 0 ||
      (bound && ::bind(handle, address.ai_addr, static_cast<socklen_t>(address.ai_addrlen)) != 0)) {
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

bool UdpSocket::send(std::string_view packet, const UdpAddress& to) {
  const sockaddr_storage address = storage(to);
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
