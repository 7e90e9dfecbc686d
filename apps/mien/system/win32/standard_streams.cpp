#include "apps/mien/system/standard_streams.h"

#include <windows.h>

#include <fcntl.h>
#include <io.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace mien::app {
namespace {

UINT code_page_before = 0;

}  // namespace

// The console stays as it is set when the program has ended, and is set back.
void prepare_standard_streams() {
  _setmode(_fileno(stdin), _O_BINARY);
  _setmode(_fileno(stdout), _O_BINARY);
  code_page_before = GetConsoleOutputCP();
  if (code_page_before != 0 && SetConsoleOutputCP(CP_UTF8) != 0) {
    std::atexit([] { SetConsoleOutputCP(code_page_before); });
  }
}

// The C library knows one of the three errors by name.
bool reader_has_gone() {
  const unsigned long system_error = _doserrno;
  const bool closed = system_error == ERROR_NO_DATA || system_error == ERROR_PIPE_NOT_CONNECTED;
  return errno == EPIPE || (errno == EINVAL && closed);
}

// Windows' pipes hold 4 KB and do not say how much room they have: a reader that is late is waited
// for.
void shorten_standard_output() {}
bool standard_output_has_room() { return true; }

}  // namespace mien::app
