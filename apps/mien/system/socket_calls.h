// Socket functions that differ between POSIX and Windows.
#pragma once

#include <chrono>

#ifdef _WIN32
#include "apps/mien/system/win32/socket_calls.h"
#else
#include "apps/mien/system/posix/socket_calls.h"
#endif

namespace mien::app {
struct SocketAddress;
}

namespace mien::app::sockets {

void start();  // must be called first; repeated calls are allowed
void close(Handle handle);
void prepare(Handle handle);  // non-blocking, not inherited, and errors of sent packets do not fail
                              // later receives
std::string last_error();
[[nodiscard]] bool would_block();  // whether the last call failed because it would wait
[[nodiscard]] bool connecting();   // whether the last call was a connect that has only begun
// The reason why a connect has failed, when the socket is writable; empty: it has succeeded.
[[nodiscard]] std::string connect_error(Handle handle);

enum class Event { kReadable, kWritable };
// Returns false if the time has passed. True also after an error, which the next call reports.
[[nodiscard]] bool wait(Handle handle, Event event, std::chrono::milliseconds within);

std::string name_error(int error);  // for errors of getaddrinfo

// Selects an address from the result of getaddrinfo: the first IPv4 address if there is one,
// because most receivers listen on IPv4 only; otherwise the first.
const addrinfo& preferred(const addrinfo& found);

sockaddr_storage storage(const SocketAddress& address);

}  // namespace mien::app::sockets
