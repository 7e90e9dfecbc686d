// mien-conformance: checks every kernel on this machine. docs/conformance.md describes options,
// columns and exit codes.
#include <mien/mien.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "apps/conformance/exit_codes.h"
#include "apps/conformance/run.h"
#include "apps/mien/system/failure.h"

namespace mien::conformance {
namespace {

void add_options(CLI::App& program, Options& options) {
  program.add_flag("--list", options.list, "lists names and tiers to check");
  program
      .add_option("--filter", options.filter, "only matching names: * is any text, ? one letter")
      ->type_name("GLOB");
  program.add_option("--tier", options.tier, "one tier only: ref, avx2, ...")->type_name("T");
  program.add_option("--seed", options.seed, "seed of the random cases; default 1")->type_name("N");
  program
      .add_option("--repeat", options.repeat,
                  "number of seeds, counting up from the first; default 1")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000));
  program.add_flag("--bench", options.bench,
                   "measures the kernels that pass, relative to the measured peak");
  program
      .add_flag("--block", options.block,
                "with --bench, instead of the table: a block of text about this device")
      ->needs("--bench");
  program
      .add_option("--json", options.json,
                  "results as JSON; - writes them to standard output, without table")
      ->type_name("FILE");
  program.add_option("--models", options.models, "folder of weight files to check")
      ->type_name("DIR");
  program.add_flag("--self-test", options.self_test,
                   "checks the checks with kernels that are wrong on purpose");
}

int main_with(int argc, char** argv) {
  CLI::App program("Checks all kernels of all tiers that this CPU supports", "mien-conformance");
  program.set_version_flag("--version", mien_version());
  Options options;
  add_options(program, options);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return run(options);
}

}  // namespace
}  // namespace mien::conformance

int main(int argc, char** argv) {
  try {
    return mien::conformance::main_with(argc, argv);
  } catch (const mien::app::Failure& failure) {  // a weight file is missing or invalid
    std::fprintf(stderr, "mien-conformance: %s\n", failure.what());
    return mien::conformance::kExitModel;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mien-conformance: %s\n", error.what());
    return mien::conformance::kExitInternal;
  }
}
