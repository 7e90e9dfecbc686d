// The program mien: facial animation from video and audio. docs/cli.md describes its verbs, options
// and exit codes.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include "apps/mien/command_line/program.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/out_of_memory.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/system/standard_streams.h"
#include "apps/mien/system/termination.h"

namespace {

// Ends the program if an allocation fails before the command line is parsed. CLI11 creates its
// validators before main, where nothing catches std::bad_alloc, and some of its functions are
// noexcept. program.cpp removes the handler.
[[gnu::constructor(101)]] void install_out_of_memory_handler() {
  std::set_new_handler(mien::app::end_without_memory);
}

}  // namespace

int main(int argc, char** argv) {
  mien::app::prepare_standard_streams();
  mien::app::clean_up_on_termination();
  try {
    const int code = mien::app::run_program(argc, argv);
    mien::app::finish_standard_output();
    return code;
  } catch (const mien::app::Failure& failure) {
    std::fprintf(stderr, "mien: %s\n", mien::app::printable(failure.what()).c_str());
    for (const std::string& detail : failure.details()) {
      std::fprintf(stderr, "  %s\n", mien::app::printable(detail).c_str());
    }
    return failure.code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mien: %s\n", mien::app::printable(error.what()).c_str());
    return mien::app::kExitInternal;
  }
}
