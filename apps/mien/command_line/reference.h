// The command line as data. --help, the manual page, completions and suggestions are generated from
// it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mien::app {

struct OptionText {
  std::vector<std::string> names;  // "-o", "--format"; for an argument its name
  std::string value;               // "FILE", "rad|norm180|deg"; empty for a flag
  std::string description;
};

struct VerbText {
  std::string name, description;
  std::vector<OptionText> arguments;  // in the order of the command line
  std::vector<OptionText> options;
  std::vector<std::string> examples;  // complete commands
};

// Sets the placeholder of every option's value, and appends the examples to each verb's help.
void finish_help(CLI::App& program);

std::vector<VerbText> verbs_of(const CLI::App& program);

// Splits "rad|norm180|deg" into its values. Empty for "FILE".
std::vector<std::string> choices(const OptionText& option);

// Returns the name in `known` with the smallest edit distance to `typed`, or "" if none is close.
std::string nearest(const std::string& typed, const std::vector<std::string>& known);

// Returns a message about a missing verb, or the first verb or option that is unknown (with the
// nearest known name), lacks its value or is repeated, or "". `arguments` are those after the
// program's name.
std::string find_usage_error(const std::vector<std::string>& arguments, const CLI::App& program);

}  // namespace mien::app
