#include "apps/mien/system/udp_socket.h"

#include <cstring>
#include <memory>

#include "apps/mien/system/failure.h"

#ifdef _WIN32
#include <winsock2.h>
#include <ws2tcpip.h>
#else
#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#endif

namespace mien::app {
namespace {

#ifdef _WIN32
using Handle = SOCKET;
using Length = int;

void start_network() {
  static const int started = [] {
    WSADATA data;
    return WSAStartup(MAKEWORD(2, 2), &data);
  }();
  static_cast<void>(started);
}
void close_handle(Handle handle) { closesocket(handle); }
void never_wait(Handle handle) {
  u_long on = 1;
  ioctlsocket(handle, FIONBIO, &on);
}
std::string last_error() { return "error " + std::to_string(WSAGetLastError()); }
std::string name_error(int) { return last_error(); }
#else
using Handle = int;
using Length = std::size_t;

void start_network() {}
void close_handle(Handle handle) { close(handle); }
void never_wait(Handle handle) {
  fcntl(handle, F_SETFL, fcntl(handle, F_GETFL) | O_NONBLOCK);
  fcntl(handle, F_SETFD, FD_CLOEXEC);
}
std::string last_error() { return std::strerror(errno); }
std::string name_error(int error) { return gai_strerror(error); }
#endif

struct FreeAddresses {
  void operator()(addrinfo* found) const { freeaddrinfo(found); }
};

sockaddr_storage storage(const UdpAddress& address) {
  sockaddr_storage made = {};
  std::memcpy(&made, address.bytes.data(), address.bytes.size());
  return made;
}

UdpAddress packed(const sockaddr_storage& address, socklen_t bytes) {
  return {std::string(reinterpret_cast<const char*>(&address), bytes)};
}

}  // namespace

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
  start_network();
  addrinfo hints = {};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    throw Failure(kExitOutput, what + ": there is no host '" + host + "': " + name_error(error));
  }
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  peer_.bytes.assign(reinterpret_cast<const char*>(found->ai_addr), found->ai_addrlen);
  const auto handle = ::socket(found->ai_family, SOCK_DGRAM, 0);
  handle_ = static_cast<std::intptr_t>(handle);
  if (handle_ < 0 ||
      (bound && ::bind(handle, found->ai_addr, static_cast<socklen_t>(found->ai_addrlen)) != 0)) {
    const std::string reason = last_error();
    if (handle_ >= 0) {
      close_handle(handle);
    }
    throw Failure(kExitOutput, what + ": port " + std::to_string(port) + " of '" + host +
                                   "' cannot be taken: " + reason);
  }
  never_wait(handle);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : handle_(other.handle_), peer_(std::move(other.peer_)) {
  other.handle_ = -1;
}

UdpSocket::~UdpSocket() {
  if (handle_ >= 0) {
    close_handle(static_cast<Handle>(handle_));
  }
}

bool UdpSocket::send(std::string_view packet, const UdpAddress& to) {
  const sockaddr_storage address = storage(to);
  return ::sendto(static_cast<Handle>(handle_), packet.data(), static_cast<Length>(packet.size()),
                  0, reinterpret_cast<const sockaddr*>(&address),
                  static_cast<socklen_t>(to.bytes.size())) ==
         static_cast<std::make_signed_t<Length>>(packet.size());
}

std::optional<Datagram> UdpSocket::receive(std::size_t most_bytes) {
  std::string bytes(most_bytes, '\0');
  sockaddr_storage from = {};
  socklen_t length = sizeof from;
  const auto got =
      ::recvfrom(static_cast<Handle>(handle_), bytes.data(), static_cast<Length>(bytes.size()), 0,
                 reinterpret_cast<sockaddr*>(&from), &length);
  if (got < 0) {
    return std::nullopt;
  }
  bytes.resize(static_cast<std::size_t>(got));
  return Datagram{std::move(bytes), packed(from, length)};
}

}  // namespace mien::app
