#include "apps/mien/command_line/completions.h"

namespace mien::app {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text.append(text.empty() ? "" : " ").append(word);
  }
  return text;
}

std::vector<std::string> names(const std::vector<VerbText>& verbs) {
  std::vector<std::string> all;
  all.reserve(verbs.size());
  for (const VerbText& verb : verbs) {
    all.push_back(verb.name);
  }
  return all;
}

std::string in_quotes(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

// Within "[...]" and behind ":" of zsh.
std::string escaped(const std::string& text) {
  std::string made;
  for (const char c : text) {
    made += std::string(c == '[' || c == ']' || c == ':' ? "\\" : "") + c;
  }
  return made;
}

std::string zsh_values(const OptionText& option) {
  const std::vector<std::string> values = choices(option);
  if (!values.empty()) {
    return "(" + joined(values) + ")";
  }
  return option.value == "FILE" || option.value == "VALUE" ? "_files"
         : option.value == "DIR"                           ? "_files -/"
                                                           : "";
}

}  // namespace

std::string bash_completion(const std::vector<VerbText>& verbs) {
  std::string text =
      "# bash completion of mien, made by `mien completion bash`\n"
      "_mien() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '" +
      joined(names(verbs)) +
      " --help --version' -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case ${COMP_WORDS[1]}:$before in\n";
  for (const VerbText& verb : verbs) {
    for (const OptionText& option : verb.options) {
      for (const std::string& name : option.names) {
        const std::vector<std::string> values = choices(option);
        if (!values.empty() || option.value == "DIR") {
          text += "    " + verb.name + ":" + name + ") mapfile -t COMPREPLY < <(compgen " +
                  (values.empty() ? "-d" : "-W '" + joined(values) + "'") +
                  " -- \"$word\"); return ;;\n";
        }
      }
    }
  }
  text +=
      "  esac\n"
      "  local options=\n"
      "  case ${COMP_WORDS[1]} in\n";
  for (const VerbText& verb : verbs) {
    std::vector<std::string> words;
    for (const OptionText& option : verb.options) {
      words.insert(words.end(), option.names.begin(), option.names.end());
    }
    for (const OptionText& argument : verb.arguments) {
      for (const std::string& value : choices(argument)) {
        words.push_back(value);
      }
    }
    text += "    " + verb.name + ") options='" + joined(words) + "' ;;\n";
  }
  return text +
         "  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\"; "
         "[[ $word == -* ]] || compgen -f -- \"$word\")\n"
         "}\n"
         "complete -o filenames -F _mien mien\n";
}

std::string zsh_completion(const std::vector<VerbText>& verbs) {
  std::string text =
      "#compdef mien\n"
      "# zsh completion of mien, made by `mien completion zsh`\n"
      "_mien() {\n"
      "  if (( CURRENT == 2 )); then\n"
      "    local -a verbs=(\n";
  for (const VerbText& verb : verbs) {
    text += "      " + in_quotes(verb.name + ":" + escaped(verb.description)) + "\n";
  }
  text +=
      "    )\n"
      "    _describe verb verbs\n"
      "    return\n"
      "  fi\n"
      "  local verb=$words[2]\n"
      "  shift words; (( CURRENT-- ))\n"
      "  case $verb in\n";
  for (const VerbText& verb : verbs) {
    text += "    " + verb.name + ") _arguments";
    for (const OptionText& option : verb.options) {
      for (const std::string& name : option.names) {
        std::string spec = "*" + name + "[" + escaped(option.description) + "]";
        if (!option.value.empty()) {
          spec +=
              ":" + (choices(option).empty() ? option.value : "value") + ":" + zsh_values(option);
        }
        text += " \\\n      " + in_quotes(spec);
      }
    }
    for (const OptionText& argument : verb.arguments) {
      const std::string values = zsh_values(argument);
      text += " \\\n      " +
              in_quotes(":" + argument.names.front() + ":" + (values.empty() ? "_files" : values));
    }
    text += " ;;\n";
  }
  return text +
         "  esac\n"
         "}\n"
         "compdef _mien mien\n";
}

std::string fish_completion(const std::vector<VerbText>& verbs) {
  std::string text =
      "# fish completion of mien, made by `mien completion fish`\n"
      "set -l verbs " +
      joined(names(verbs)) + "\n";
  for (const VerbText& verb : verbs) {
    text += "complete -c mien -f -n \"not __fish_seen_subcommand_from $verbs\" -a " + verb.name +
            " -d " + in_quotes(verb.description) + "\n";
  }
  for (const VerbText& verb : verbs) {
    const std::string begin = "complete -c mien -n '__fish_seen_subcommand_from " + verb.name + "'";
    for (const OptionText& option : verb.options) {
      text += begin;
      for (const std::string& name : option.names) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      const std::vector<std::string> values = choices(option);
      text += option.value.empty() ? ""
              : values.empty()     ? " -r"
                                   : " -x -a '" + joined(values) + "'";
      text += " -d " + in_quotes(option.description) + "\n";
    }
    for (const OptionText& argument : verb.arguments) {
      if (!choices(argument).empty()) {
        text += begin + " -f -a '" + joined(choices(argument)) + "'\n";
      }
    }
  }
  return text;
}

}  // namespace mien::app
