#include "apps/mien/system/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>

namespace mien::app {

void prepare_standard_streams() { signal(SIGPIPE, SIG_IGN); }

bool reader_has_gone() { return errno == EPIPE; }

void shorten_standard_output() {
#ifdef F_SETPIPE_SZ
  // A pipe holds 64 KB unless told otherwise, which is a second of lines that are late.
  constexpr int kMinBytes = 8192;
  fcntl(STDOUT_FILENO, F_SETPIPE_SZ, kMinBytes);
#endif
}

// A pipe that can be written to takes a page at once, which is more than a line has.
bool standard_output_has_room() {
  pollfd room{STDOUT_FILENO, POLLOUT, 0};
  return poll(&room, 1, 0) != 0;
}

}  // namespace mien::app
