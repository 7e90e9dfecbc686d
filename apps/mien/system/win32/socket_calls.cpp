// Socket functions on Windows.
#include "apps/mien/system/socket_calls.h"

#include <mswsock.h>

#include <system_error>

namespace mien::app::sockets {

void start() {
  static const int started = [] {
    WSADATA data;
    return WSAStartup(MAKEWORD(2, 2), &data);
  }();
  static_cast<void>(started);
}

void close(Handle handle) { closesocket(handle); }

// By default, Windows reports an unreachable receiver as an error of the next receive.
void prepare(Handle handle) {
  u_long on = 1;
  ioctlsocket(handle, FIONBIO, &on);
  BOOL off = FALSE;
  DWORD nothing = 0;
  WSAIoctl(handle, SIO_UDP_CONNRESET, &off, sizeof off, nullptr, 0, &nothing, nullptr, nullptr);
}

std::string last_error() { return std::system_category().message(WSAGetLastError()); }

bool would_block() { return WSAGetLastError() == WSAEWOULDBLOCK; }

bool connecting() { return would_block(); }

std::string connect_error(Handle handle) {
  int error = 0;
  socklen_t bytes = sizeof error;
  if (getsockopt(handle, SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&error), &bytes) != 0) {
    error = WSAGetLastError();
  }
  return error == 0 ? "" : std::system_category().message(error);
}

bool wait(Handle handle, Event event, std::chrono::milliseconds within) {
  WSAPOLLFD waiting = {handle,
                       static_cast<SHORT>(event == Event::kReadable ? POLLRDNORM : POLLWRNORM), 0};
  return WSAPoll(&waiting, 1, static_cast<int>(within.count())) > 0;
}

std::string name_error(int error) { return std::system_category().message(error); }

}  // namespace mien::app::sockets
