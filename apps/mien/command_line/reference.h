// The command line as data: what --help, the manual page, completions and suggestions are all made
// of.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mien::app {

struct OptionText {
  std::vector<std::string> names;  // "-o", "--format"; of an argument its word
  std::string value;               // "FILE", "rad|norm180|deg"; empty: takes none
  std::string description;
};

struct VerbText {
  std::string name, description;
  std::vector<OptionText> arguments;  // in their order
  std::vector<OptionText> options;
  std::vector<std::string> examples;  // whole commands
};

// Says for every option what its value is called, and puts examples below each verb's help.
void finish_help(CLI::App& program);

std::vector<VerbText> verbs_of(const CLI::App& program);

// The values of "rad|norm180|deg"; none for "FILE".
std::vector<std::string> choices(const OptionText& option);

// Of those the one that was probably meant, or nothing.
std::string nearest(const std::string& typed, const std::vector<std::string>& known);

// What is wrong with a word that is no verb or no option, with the nearest that is one; nothing
// where all are known. For the arguments behind the program's name.
std::string complaint_about(const std::vector<std::string>& arguments, const CLI::App& program);

}  // namespace mien::app
