// Options for trackers, shared by several verbs. `Options` is a struct with the members they set.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "apps/mien/command_line/option_values.h"

namespace mien::app {

template <typename Options>
void add_voice_strength(CLI::App& verb, Options& options) {
  verb.add_option("--voice-strength", options.voice_strength,
                  "factor on the controls predicted from audio, 0 to 4 (default 1)")
      ->check(number_from(0.0, 4.0));
}

template <typename Options>
void add_field_of_view(CLI::App& verb, Options& options) {
  verb.add_option("--fov", options.fov_degrees,
                  "horizontal field of view of the camera in degrees, 1 to 170 (default 60); "
                  "distance and head pose depend on it")
      ->check(number_from(1.0, 170.0));
}

template <typename Options>
void add_level_options(CLI::App& verb, Options& options) {
  verb.add_option("--lod", options.lod,
                  "level of detail: 1 (cheapest) to 4, or auto (default: the highest that the "
                  "models support)")
      ->transform(one_of<int>({{"1", 1}, {"2", 2}, {"3", 3}, {"4", 4}, {"auto", 0}}));
  verb.add_option("--budget-ms", options.budget_ms,
                  "with --lod auto: mean time per frame in milliseconds (default 10)")
      ->check(number_from(0.01, 1e6));
}

}  // namespace mien::app
