#include "apps/mien/command_line/manual.h"

#include "apps/mien/system/exit_codes.h"

namespace mien::app {
namespace {

// Backslashes and leading dots mean something to troff, and '-' would become a hyphen.
std::string plain(const std::string& text) {
  std::string made;
  for (const char c : text) {
    if (c == '\\') {
      made += "\\e";
    } else if (c == '-') {
      made += "\\-";
    } else {
      made += c;
    }
  }
  return made.starts_with('.') || made.starts_with('\'') ? "\\&" + made : made;
}

std::string tagged(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + "\n" + plain(text) + "\n";
}

// A long list of values may be broken between two of them.
std::string breakable(const std::string& values) {
  std::string made;
  for (const char c : values) {
    made += c;
    if (c == '|') {
      made += "\\:";
    }
  }
  return made;
}

std::string option_tag(const OptionText& option) {
  std::string tag = "\\fB";
  for (std::size_t i = 0; i < option.names.size(); ++i) {
    tag += (i == 0 ? "" : "\\fR, \\fB") + plain(option.names[i]);
  }
  tag += "\\fR";
  return option.value.empty() ? tag : tag + " \\fI" + breakable(plain(option.value)) + "\\fR";
}

}  // namespace

std::string manual_page(const std::vector<VerbText>& verbs, const std::string& description,
                        const std::string& version) {
  std::string page = ".TH MIEN 1 \"\" \"mien " + plain(version) +
                     "\" \"User Commands\"\n.SH NAME\nmien \\- " + plain(description) +
                     "\n.SH SYNOPSIS\n";
  for (const VerbText& verb : verbs) {
    page += ".B mien " + verb.name + "\n[options]";
    for (const OptionText& argument : verb.arguments) {
      page += " \\fI" + plain(argument.names.front()) + "\\fR";
    }
    page += "\n.br\n";
  }
  for (const VerbText& verb : verbs) {
    page += ".SH MIEN " + verb.name + "\n" + plain(verb.description) + ".\n";
    for (const OptionText& argument : verb.arguments) {
      page += tagged("\\fI" + plain(argument.names.front()) + "\\fR", argument.description);
    }
    for (const OptionText& option : verb.options) {
      page += tagged(option_tag(option), option.description);
    }
    if (!verb.examples.empty()) {
      page += ".PP\nExamples:\n.PP\n.nf\n.RS\n";
      for (const std::string& example : verb.examples) {
        page += plain(example) + "\n";
      }
      page += ".RE\n.fi\n";
    }
  }
  page += ".SH EXIT STATUS\n";
  for (const ExitMeaning& exit : kExitMeanings) {
    page += tagged(std::to_string(exit.code), exit.meaning);
  }
  return page + ".SH ENVIRONMENT\n" +
         tagged("MIEN_MODELS", "folder of the model files, where --models does not name one") +
         ".SH FILES\nFormats and columns are described in docs/cli.md of the source.\n";
}

}  // namespace mien::app
