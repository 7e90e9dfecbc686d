// Generates the manual page from the command line as data.
#include "apps/mien/command_line/manual.h"

#include "apps/mien/system/exit_codes.h"

namespace mien::app {
namespace {

// Escapes text for troff: backslashes and leading dots are commands, and '-' would become a hyphen.
std::string troff_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string tagged(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + "\n" + troff_escaped(text) + "\n";
}

// Permits line breaks between the values of a long list.
std::string breakable(const std::string& values) {
  std::string result;
  for (const char c : values) {
    result += c;
    if (c == '|') {
      result += "\\:";
    }
  }
  return result;
}

std::string option_tag(const OptionText& option) {
  std::string tag = "\\fB";
  for (std::size_t i = 0; i < option.names.size(); ++i) {
    tag += (i == 0 ? "" : "\\fR, \\fB") + troff_escaped(option.names[i]);
  }
  tag += "\\fR";
  return option.value.empty() ? tag
                              : tag + " \\fI" + breakable(troff_escaped(option.value)) + "\\fR";
}

}  // namespace

std::string manual_page(const std::vector<VerbText>& verbs, const std::string& description,
                        const std::string& version) {
  std::string page = ".TH MIEN 1 \"\" \"mien " + troff_escaped(version) +
                     "\" \"User Commands\"\n.SH NAME\nmien \\- " + troff_escaped(description) +
                     "\n.SH SYNOPSIS\n";
  for (const VerbText& verb : verbs) {
    page += ".B mien " + verb.name + "\n[options]";
    for (const OptionText& argument : verb.arguments) {
      page += " \\fI" + troff_escaped(argument.names.front()) + "\\fR";
    }
    page += "\n.br\n";
  }
  for (const VerbText& verb : verbs) {
    page += ".SH MIEN " + verb.name + "\n" + troff_escaped(verb.description) + ".\n";
    for (const OptionText& argument : verb.arguments) {
      page += tagged("\\fI" + troff_escaped(argument.names.front()) + "\\fR", argument.description);
    }
    for (const OptionText& option : verb.options) {
      page += tagged(option_tag(option), option.description);
    }
    if (!verb.examples.empty()) {
      page += ".PP\nExamples:\n.PP\n.nf\n.RS\n";
      for (const std::string& example : verb.examples) {
        page += troff_escaped(example) + "\n";
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
