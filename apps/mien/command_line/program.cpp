// Builds the command line, parses it and runs the verb.
#include "apps/mien/command_line/program.h"

#include <mien/mien.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>
#include <sstream>
#include <string>

#include "apps/mien/command_line/reference.h"
#include "apps/mien/command_line/verbs.h"
#include "apps/mien/system/failure.h"

namespace mien::app {

int run_program(int argc, char** argv) {
  CLI::App program("Facial animation from video and audio, in real time, on a CPU", "mien");
  program.set_version_flag("--version", mien_version());
  program.require_subcommand(1);
  program.allow_windows_style_options(false);  // "/x" is a file on all systems
  add_track(program);
  add_live(program);
  add_devices(program);
  add_convert(program);
  add_neutral(program);
  add_inspect(program);
  add_run(program);
  add_bench(program);
  add_compare(program);
  add_completion(program);
  add_manual(program);
  finish_help(program);
  // From here on a failed allocation throws; before, it ends the program (main.cpp).
  program.parse_complete_callback([] { std::set_new_handler(nullptr); });
  const std::string usage_error = find_usage_error({argv + 1, argv + argc}, program);
  if (!usage_error.empty()) {
    throw Failure(kExitUsage, usage_error);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help, --version
    std::ostringstream text;
    program.exit(wanted, text);
    std::fputs(text.str().c_str(), stdout);
  } catch (const CLI::ExtrasError&) {
    throw Failure(kExitUsage, "unexpected argument '" + program.remaining(true).front() + "'");
  } catch (const CLI::ParseError& error) {
    throw Failure(kExitUsage, error.what());
  }
  return kExitOk;
}

}  // namespace mien::app
