// Socket addresses on both families of systems.
#include "apps/mien/system/socket_address.h"

#include <cstring>
#include <memory>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/socket_calls.h"

namespace mien::app {
namespace {

struct FreeAddresses {
  void operator()(addrinfo* found) const { freeaddrinfo(found); }
};

}  // namespace

const addrinfo& sockets::preferred(const addrinfo& found) {
  for (const addrinfo* address = &found; address != nullptr; address = address->ai_next) {
    if (address->ai_family == AF_INET) {
      return *address;
    }
  }
  return found;
}

sockaddr_storage sockets::storage(const SocketAddress& address) {
  sockaddr_storage result = {};
  std::memcpy(&result, address.bytes.data(), address.bytes.size());
  return result;
}

SocketAddress SocketAddress::of(const std::string& host, std::uint16_t port,
                                const std::string& what) {
  sockets::start();
  addrinfo hints = {};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;  // one result per address; stream sockets use the same addresses
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    throw Failure(kExitOutput,
                  what + ": unknown host '" + host + "': " + sockets::name_error(error));
  }
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  const addrinfo& address = sockets::preferred(*found);
  return {std::string(reinterpret_cast<const char*>(address.ai_addr), address.ai_addrlen)};
}

int SocketAddress::family() const { return sockets::storage(*this).ss_family; }

bool SocketAddress::loopback() const {
  const sockaddr_storage address = sockets::storage(*this);
  if (address.ss_family == AF_INET6) {
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr) != 0;
  }
  const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
  return ntohl(v4.sin_addr.s_addr) >> 24 == 127;
}

std::uint16_t SocketAddress::port() const {
  const sockaddr_storage address = sockets::storage(*this);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

SocketAddress SocketAddress::with_port(std::uint16_t port) const {
  sockaddr_storage address = sockets::storage(*this);
  (address.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(address).sin6_port
                                 : reinterpret_cast<sockaddr_in&>(address).sin_port) = htons(port);
  return {std::string(reinterpret_cast<const char*>(&address), bytes.size())};
}

}  // namespace mien::app
