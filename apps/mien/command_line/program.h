// The command line as a whole.
#pragma once

namespace mien::app {

// Does what the arguments ask for and returns the exit code. Throws Failure.
int run_program(int argc, char** argv);

}  // namespace mien::app
