// Standard streams on Windows.
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

// The console keeps its code page after the program ends, so it is restored.
void prepare_standard_streams() {
  _setmode(_fileno(stdin), _O_BINARY);
  _setmode(_fileno(stdout), _O_BINARY);
  code_page_before = GetConsoleOutputCP();
  if (code_page_before != 0 && SetConsoleOutputCP(CP_UTF8) != 0) {
    std::atexit([] { SetConsoleOutputCP(code_page_before); });
  }
}

// The C library maps only one of the three errors to errno.
bool reader_has_closed() {
  const unsigned long system_error = _doserrno;
  const bool closed = system_error == ERROR_NO_DATA || system_error == ERROR_PIPE_NOT_CONNECTED;
  return errno == EPIPE || (errno == EINVAL && closed);
}

// Pipes of Windows hold 4 KB and do not report their free space, so writing waits for a slow
// reader.
void shorten_standard_output() {}
bool standard_output_is_writable() { return true; }

}  // namespace mien::app
