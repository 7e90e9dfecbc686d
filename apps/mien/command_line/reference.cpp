// Describes the command line as data, and suggests the nearest verb or option for a typing error.
#include "apps/mien/command_line/reference.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

namespace mien::app {
namespace {

constexpr const char* kFormats =
    "csv|jsonl|llf|gltf|glb|bvh|roblox|visemes|rhubarb|rhubarb-json|rhubarb-xml|rhubarb-dat";

// The placeholder of each option's value. An option has the same one in all verbs.
const std::map<std::string, std::string>& value_names() {
  static const std::map<std::string, std::string> names = {
      {"-o", "FILE"},
      {"--format", kFormats},
      {"--from", kFormats},
      {"--to", kFormats},
      {"--llf-rot", "rad|norm180|deg"},
      {"--from-llf-rot", "rad|norm180|deg"},
      {"--llf-fps", "N"},
      {"--from-llf-fps", "N"},
      {"--bvh-unit", "m|cm|mm|in"},
      {"--from-bvh-unit", "m|cm|mm|in"},
      {"--roblox-lod", "0|1"},
      {"--avatar", "FILE"},
      {"--landmarks", "FILE"},
      {"--overlay", "FILE"},
      {"--report", "FILE"},
      {"--report-clip-mb", "MB"},
      {"--audio", "FILE"},
      {"--audio-track", "N"},
      {"--rotate", "0|90|180|270"},
      {"--rounds", "N"},
      {"--mode", "av|video|audio"},
      {"--av-offset-ms", "MS"},
      {"--voice-strength", "X"},
      {"--fov", "DEGREES"},
      {"--stats", "FILE"},
      {"--lod", "1|2|3|4|auto"},
      {"--budget-ms", "MS"},
      {"--neutral", "FILE"},
      {"--profile", "FILE"},
      {"--page", "[PORT]"},
      {"--page-token", "FILE"},
      {"--max-faces", "N"},
      {"--tier", "NAME"},
      {"--models", "DIR"},
      {"--start", "S"},
      {"--duration", "S"},
      {"--out", "DIR"},
      {"--jobs", "N"},
      {"--fps", "N"},
      {"--face", "ID"},
      {"--input", "FILE"},
      {"--output", "FILE"},
      {"--network", "NAME"},
      {"--layout", "chw|hwc"},
      {"--model", "NAME"},
      {"--clip", "FILE"},
      {"--levels", "FILE"},
      {"--video", "FILE"},
      {"--camera", "DEVICE"},
      {"--mic", "DEVICE"},
      {"--send", "URL"},
      {"SHELL", "bash|zsh|fish"},
  };
  return names;
}

const std::map<std::string, std::vector<std::string>>& examples() {
  static const std::map<std::string, std::vector<std::string>> of_verbs = {
      {"track",
       {"mien track face.mp4 -o curves.csv --overlay overlay.mp4",
        "mien track face.mp4 --report face.html",
        "mien track face.mp4 -o face.glb -o face.llf.csv -o face.jsonl",
        "mien track speech.wav --format visemes -o mouth.csv", "mien track face.mp4 | head -3",
        "mien track clips/ --out curves/ --jobs 4 --format glb"}},
      {"live",
       {"mien live --send vmc://", "mien live --camera 1 --mic none --send llf://192.168.0.5",
        "mien live --send 'vmc://?names=vrm1' --send osf:// --send opentrack://",
        "mien live --page --send vmc:// --profile me.json",
        "mien live --camera test:face.mp4 --send - | head -3",
        "mien live --camera rtsp://192.168.0.9/stream --send jsonl://127.0.0.1:9000"}},
      {"devices", {"mien devices", "mien devices --json"}},
      {"convert",
       {"mien convert curves.csv face.glb", "mien convert take.csv take.jsonl --from llf",
        "mien convert face.glb head.bvh --fps 30", "mien convert cues.tsv - --to csv --fps 30"}},
      {"neutral",
       {"mien neutral at_rest.mp4 -o me.neutral", "mien track face.mp4 --neutral me.neutral"}},
      {"compare",
       {"mien compare a.csv b.csv -o page.html --video face.mp4",
        "mien compare curves.csv take.glb -o page.html"}},
      {"inspect", {"mien inspect models/basenet.mien", "mien inspect models/hifinet.mien --json"}},
      {"run",
       {"mien run model.mien --input x.npy --output y.npy",
        "mien run models/basenet.mien --network encoder --input x.npy --output a.npy --output "
        "b.npy"}},
      {"bench", {"mien bench", "mien bench --levels face.mp4 --json"}},
      {"completion",
       {"mien completion bash > ~/.local/share/bash-completion/completions/mien",
        "mien completion zsh > ~/.zfunc/_mien",
        "mien completion fish > ~/.config/fish/completions/mien.fish"}},
      {"manual", {"mien manual > mien.1 && man -l mien.1"}},
  };
  return of_verbs;
}

std::string footer(const std::vector<std::string>& commands) {
  std::string text = "Examples:";
  for (const std::string& command : commands) {
    text += "\n  " + command;
  }
  return text;
}

OptionText text_of(const CLI::Option& option) {
  OptionText text;
  if (option.get_positional()) {
    text.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) {
      text.names.push_back("-" + name);
    }
    for (const std::string& name : option.get_lnames()) {
      text.names.push_back("--" + name);
    }
  }
  if (option.get_items_expected_max() > 0) {
    text.value = option.get_option_text().empty() ? "VALUE" : option.get_option_text();
  }
  text.description = option.get_description();
  return text;
}

// Edit distance of insertions, deletions, replacements and transpositions (Damerau, 1964).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        cost[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({replaced, cost[i - 1][j] + 1, cost[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
      }
    }
  }
  return cost[a.size()][b.size()];
}

std::string with_suggestion(const std::string& what, const std::string& typed,
                            const std::vector<std::string>& known) {
  const std::string suggestion = nearest(typed, known);
  return suggestion.empty() ? what : what + "; did you mean '" + suggestion + "'?";
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         (word[1] == '-' ? word.size() > 2 : word[1] < '0' || word[1] > '9') && word[1] != '.';
}

// The name without the value: "--lod=3" is --lod, "-ofile" is -o.
std::string option_name(const std::string& word) {
  return word[1] == '-' ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    const OptionText text = text_of(*option);
    if (!option->get_positional()) {
      names.insert(names.end(), text.names.begin(), text.names.end());
    }
  }
  return names;
}

// Whether the option at the end of `words` or before another option lacks its value.
bool lacks_value(const CLI::Option& option, std::span<const std::string> words) {
  const bool attached = words[0] != option_name(words[0]);
  return option.get_items_expected_min() > 0 && !attached &&
         (words.size() == 1 || is_option(words[1]));
}

// Returns a message about the first option that is unknown, lacks its value or is repeated, or "".
std::string option_error(std::span<const std::string> arguments, const CLI::App& verb) {
  std::set<const CLI::Option*> seen;
  for (std::size_t i = 1; i < arguments.size() && arguments[i] != "--"; ++i) {
    if (!is_option(arguments[i])) {
      continue;
    }
    const std::string name = option_name(arguments[i]);
    const CLI::Option* option = verb.get_option_no_throw(name);
    if (option == nullptr) {
      return with_suggestion(verb.get_name() + ": unknown option '" + name + "'", name,
                             option_names(verb));
    }
    if (lacks_value(*option, arguments.subspan(i))) {
      return name + ": value missing (expected " + option->get_option_text() + ")";
    }
    const bool single = option->get_items_expected_max() == 1 &&
                        option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw;
    if (!seen.insert(option).second && single) {
      return name + ": may be given only once";
    }
  }
  return {};
}

}  // namespace

void finish_help(CLI::App& program) {
  for (CLI::App* verb : program.get_subcommands({})) {
    for (CLI::Option* option : verb->get_options()) {
      const auto known = value_names().find(text_of(*option).names.back());
      if (known != value_names().end() && option->get_items_expected_max() > 0) {
        option->option_text(known->second);
      } else if (option->get_positional()) {
        option->option_text(" ");
      }
    }
    const auto commands = examples().find(verb->get_name());
    if (commands != examples().end()) {
      verb->footer(footer(commands->second));
    }
  }
  program.footer("`mien VERB --help` describes a verb, `mien manual` prints the whole manual.");
}

std::vector<VerbText> verbs_of(const CLI::App& program) {
  std::vector<VerbText> verbs;
  for (const CLI::App* verb : program.get_subcommands({})) {
    VerbText text;
    text.name = verb->get_name();
    text.description = verb->get_description();
    for (const CLI::Option* option : verb->get_options()) {
      (option->get_positional() ? text.arguments : text.options).push_back(text_of(*option));
    }
    const auto commands = examples().find(text.name);
    if (commands != examples().end()) {
      text.examples = commands->second;
    }
    verbs.push_back(text);
  }
  return verbs;
}

std::vector<std::string> choices(const OptionText& option) {
  std::vector<std::string> values;
  for (std::size_t begin = 0; option.value.find('|') != std::string::npos;) {
    const std::size_t end = option.value.find('|', begin);
    values.push_back(option.value.substr(begin, end - begin));
    if (end == std::string::npos) {
      break;
    }
    begin = end + 1;
  }
  return values;
}

std::string nearest(const std::string& typed, const std::vector<std::string>& known) {
  std::string best;
  std::size_t min_steps = std::max<std::size_t>(1, typed.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t steps = distance(typed, candidate);
    if (steps < min_steps) {
      min_steps = steps;
      best = candidate;
    }
  }
  return best;
}

std::string find_usage_error(const std::vector<std::string>& arguments, const CLI::App& program) {
  if (arguments.empty()) {
    return "a verb is required; `mien --help` lists them";
  }
  const std::string& first = arguments.front();
  std::vector<std::string> names = option_names(program);
  if (is_option(first)) {
    const bool known = std::find(names.begin(), names.end(), option_name(first)) != names.end();
    return known ? "" : with_suggestion("unknown option '" + first + "'", first, names);
  }
  names.clear();
  const CLI::App* verb = nullptr;
  for (const CLI::App* candidate : program.get_subcommands({})) {
    names.push_back(candidate->get_name());
    verb = candidate->get_name() == first ? candidate : verb;
  }
  if (verb == nullptr) {
    return with_suggestion("unknown verb '" + first + "'", first, names);
  }
  return option_error(arguments, *verb);
}

}  // namespace mien::app
