// mien: facial animation from video and sound. docs/cli.md describes the verbs, options and exit
// codes.
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "apps/mien/command_line/program.h"
#include "apps/mien/system/failure.h"

namespace {

// CLI11 makes its validators before main, where nobody could catch that there is no memory, and
// some of its functions let no exception through. Until the command line is read (program.cpp).
[[gnu::constructor(101)]] void end_without_memory() {
  std::set_new_handler([] {
    std::fputs("mien: no memory\n", stderr);
    std::_Exit(mien::app::kExitInternal);
  });
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that goes away shows as a failed write, with a message, not as a silent death.
  signal(SIGPIPE, SIG_IGN);
  try {
    return mien::app::run_program(argc, argv);
  } catch (const mien::app::Failure& failure) {
    std::fprintf(stderr, "mien: %s\n", failure.what());
    return failure.code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mien: %s\n", error.what());
    return mien::app::kExitInternal;
  }
}
