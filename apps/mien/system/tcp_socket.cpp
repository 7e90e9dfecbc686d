// TCP sockets on both families of systems.
#include "apps/mien/system/tcp_socket.h"

#include <algorithm>
#include <utility>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/socket_calls.h"

namespace mien::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kPendingConnections = 16;

sockets::Handle native(std::intptr_t handle) { return static_cast<sockets::Handle>(handle); }

milliseconds until(steady_clock::time_point end) {
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(end - steady_clock::now()));
}

void set_flag(sockets::Handle handle, int level, int option) {
  const int on = 1;
  static_cast<void>(
      ::setsockopt(handle, level, option, reinterpret_cast<const char*>(&on), sizeof on));
}

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

bool listens(sockets::Handle handle, std::uint16_t port) {
  sockets::prepare(handle);
  set_flag(handle, SOL_SOCKET, sockets::kExclusivePort);
  const sockaddr_in address = loopback(port);
  return ::bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
         ::listen(handle, kPendingConnections) == 0;
}

}  // namespace

TcpConnection::TcpConnection(const SocketAddress& server) {
  const auto handle = ::socket(server.family(), SOCK_STREAM, 0);
  handle_ = static_cast<std::intptr_t>(handle);
  if (handle_ < 0) {
    connect_error_ = sockets::last_error();
    return;
  }
  sockets::prepare(handle);
  set_flag(handle, IPPROTO_TCP, TCP_NODELAY);
  const sockaddr_storage address = sockets::storage(server);
  if (::connect(handle, reinterpret_cast<const sockaddr*>(&address),
                static_cast<socklen_t>(server.bytes.size())) != 0 &&
      !sockets::connecting()) {
    connect_error_ = sockets::last_error();
  }
}

TcpConnection::TcpConnection(TcpConnection&& other) noexcept
    : handle_(other.handle_), connect_error_(std::move(other.connect_error_)) {
  other.handle_ = -1;
}

TcpConnection::~TcpConnection() {
  if (handle_ >= 0) {
    sockets::close(native(handle_));
  }
}

TcpConnection::Connected TcpConnection::connected(std::string& reason) const {
  reason = connect_error_;
  if (reason.empty()) {
    if (!sockets::wait(native(handle_), sockets::Event::kWritable, milliseconds(0))) {
      return Connected::kNotYet;
    }
    reason = sockets::connect_error(native(handle_));
  }
  return reason.empty() ? Connected::kYes : Connected::kFailed;
}

TcpConnection::Received TcpConnection::receive(std::string& bytes, std::size_t max_bytes,
                                               milliseconds within) {
  if (!sockets::wait(native(handle_), sockets::Event::kReadable, within)) {
    return Received::kNothing;
  }
  const std::size_t before = bytes.size();
  bytes.resize(before + max_bytes);
  const auto got =
      ::recv(native(handle_), bytes.data() + before, static_cast<sockets::Length>(max_bytes), 0);
  bytes.resize(before + (got > 0 ? static_cast<std::size_t>(got) : 0));
  if (got > 0) {
    return Received::kBytes;
  }
  return got < 0 && sockets::would_block() ? Received::kNothing : Received::kClosed;
}

bool TcpConnection::send(std::string_view bytes, milliseconds within) {
  const auto end = steady_clock::now() + within;
  while (!bytes.empty()) {
    const auto sent =
        ::send(native(handle_), bytes.data(), static_cast<sockets::Length>(bytes.size()), 0);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (!sockets::would_block() ||
               !sockets::wait(native(handle_), sockets::Event::kWritable, until(end))) {
      return false;
    }
  }
  return true;
}

bool TcpConnection::send_some(std::string& bytes) {
  const auto sent =
      ::send(native(handle_), bytes.data(), static_cast<sockets::Length>(bytes.size()), 0);
  if (sent > 0) {
    bytes.erase(0, static_cast<std::size_t>(sent));
  }
  return sent >= 0 || sockets::would_block();
}

TcpListener::TcpListener(std::uint16_t port, const std::string& what) {
  sockets::start();
  const auto handle = ::socket(AF_INET, SOCK_STREAM, 0);
  handle_ = static_cast<std::intptr_t>(handle);
  sockaddr_in address = {};
  socklen_t bytes = sizeof address;
  if (handle_ < 0 || !listens(handle, port) ||
      ::getsockname(handle, reinterpret_cast<sockaddr*>(&address), &bytes) != 0) {
    const std::string reason = sockets::last_error();
    if (handle_ >= 0) {
      sockets::close(handle);
    }
    throw Failure(kExitOutput, what + ": cannot listen on port " + std::to_string(port) +
                                   " of 127.0.0.1: " + reason);
  }
  port_ = ntohs(address.sin_port);
}

TcpListener::~TcpListener() { sockets::close(native(handle_)); }

std::optional<TcpConnection> TcpListener::accept(milliseconds within) {
  if (!sockets::wait(native(handle_), sockets::Event::kReadable, within)) {
    return std::nullopt;
  }
  const auto handle = ::accept(native(handle_), nullptr, nullptr);
  if (static_cast<std::intptr_t>(handle) < 0) {
    return std::nullopt;  // the client has given up
  }
  sockets::prepare(handle);
  set_flag(handle, IPPROTO_TCP, TCP_NODELAY);  // events are small and must not wait
  return TcpConnection(static_cast<std::intptr_t>(handle));
}

}  // namespace mien::app
