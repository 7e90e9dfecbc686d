// Socket calls of Winsock, under the names that udp_socket.cpp uses on every system.
#pragma once

#include <winsock2.h>
#include <ws2tcpip.h>

#include <string>

namespace mien::app::sockets {

using Handle = SOCKET;
using Length = int;

// SO_REUSEADDR would let other programs take over the port.
inline constexpr int kExclusivePort = SO_EXCLUSIVEADDRUSE;

}  // namespace mien::app::sockets
