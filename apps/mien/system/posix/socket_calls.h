// Socket calls of POSIX, under the names that udp_socket.cpp uses on every system.
#pragma once

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstddef>
#include <string>

namespace mien::app::sockets {

using Handle = int;
using Length = std::size_t;

}  // namespace mien::app::sockets
