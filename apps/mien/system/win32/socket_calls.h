// Socket calls of Winsock, under the names that udp_socket.cpp uses on every system.
#pragma once

#include <winsock2.h>
#include <ws2tcpip.h>

#include <string>

namespace mien::app::sockets {

using Handle = SOCKET;
using Length = int;

}  // namespace mien::app::sockets
