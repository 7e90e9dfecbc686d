// The verbs of the program. Each function adds one verb with its options and its callback.
#pragma once

#include <CLI/CLI.hpp>

namespace mien::app {

void add_track(CLI::App& program);
void add_live(CLI::App& program);
void add_devices(CLI::App& program);
void add_neutral(CLI::App& program);
void add_convert(CLI::App& program);
void add_compare(CLI::App& program);
void add_inspect(CLI::App& program);
void add_run(CLI::App& program);
void add_bench(CLI::App& program);
void add_completion(CLI::App& program);
void add_manual(CLI::App& program);

}  // namespace mien::app
