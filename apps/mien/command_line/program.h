// The command line of the program.
#pragma once

namespace mien::app {

// Runs the verb that the arguments select. Returns the exit code. Throws Failure.
int run_program(int argc, char** argv);

}  // namespace mien::app
