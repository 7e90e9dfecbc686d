// Standard streams on POSIX systems.
#include "apps/mien/system/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>

namespace mien::app {

void prepare_standard_streams() { signal(SIGPIPE, SIG_IGN); }

bool reader_has_closed() { return errno == EPIPE; }

void shorten_standard_output() {
#ifdef F_SETPIPE_SZ
  // A pipe holds 64 KB by default, a second of lines, and thus of latency.
  constexpr int kPipeBytes = 8192;
  fcntl(STDOUT_FILENO, F_SETPIPE_SZ, kPipeBytes);
#endif
}

// A writable pipe accepts at least a page, more than a line needs.
bool standard_output_is_writable() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) != 0;
}

}  // namespace mien::app
