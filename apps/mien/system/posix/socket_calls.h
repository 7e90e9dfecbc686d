// Socket calls of POSIX, under the names that udp_socket.cpp uses on every system.
#pragma once

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cstddef>
#include <string>

namespace mien::app::sockets {

using Handle = int;
using Length = std::size_t;

// The option that lets a server listen again on the port of a program that has just ended, while
// two programs cannot share a port.
inline constexpr int kExclusivePort = SO_REUSEADDR;

}  // namespace mien::app::sockets
