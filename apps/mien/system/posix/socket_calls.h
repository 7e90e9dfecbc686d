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
