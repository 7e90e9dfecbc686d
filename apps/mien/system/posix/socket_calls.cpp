// Socket functions on POSIX systems.
#include "apps/mien/system/socket_calls.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace mien::app::sockets {

void start() {}

void close(Handle handle) { ::close(handle); }

void prepare(Handle handle) {
  fcntl(handle, F_SETFL, fcntl(handle, F_GETFL) | O_NONBLOCK);
  fcntl(handle, F_SETFD, FD_CLOEXEC);
}

std::string last_error() { return std::strerror(errno); }

bool would_block() { return errno == EAGAIN || errno == EINTR; }

bool connecting() { return errno == EINPROGRESS; }

std::string connect_error(Handle handle) {
  int error = 0;
  socklen_t bytes = sizeof error;
  if (getsockopt(handle, SOL_SOCKET, SO_ERROR, &error, &bytes) != 0) {
    error = errno;
  }
  return error == 0 ? "" : std::strerror(error);
}

bool wait(Handle handle, Event event, std::chrono::milliseconds within) {
  pollfd waiting = {handle, static_cast<short>(event == Event::kReadable ? POLLIN : POLLOUT), 0};
  return poll(&waiting, 1, static_cast<int>(within.count())) > 0;
}

std::string name_error(int error) { return gai_strerror(error); }

}  // namespace mien::app::sockets
