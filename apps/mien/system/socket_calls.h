// What sockets of the two families of systems do not have in common.
#pragma once

#ifdef _WIN32
#include "apps/mien/system/win32/socket_calls.h"
#else
#include "apps/mien/system/posix/socket_calls.h"
#endif

namespace mien::app::sockets {

void start();  // once or more, before all else
void close(Handle handle);
void prepare(Handle handle);  // so that it never waits, no child has it, and nothing sent is an
                              // error of what is received
std::string last_error();
std::string name_error(int error);  // of getaddrinfo

// Of what getaddrinfo found, the address to take: the first of IPv4, on which most receivers listen
// alone, even where the system would rather have the name's other ones; else the first.
const addrinfo& preferred(const addrinfo& found);

}  // namespace mien::app::sockets
