// Options of `mien completion` and `mien manual`.
#include <mien/mien.h>

#include <cstdio>
#include <memory>

#include "apps/mien/command_line/completions.h"
#include "apps/mien/command_line/manual.h"
#include "apps/mien/command_line/option_values.h"
#include "apps/mien/command_line/verbs.h"

namespace mien::app {

void add_completion(CLI::App& program) {
  auto* verb = program.add_subcommand("completion", "Print completions for a shell");
  auto shell = std::make_shared<std::string>();
  verb->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->transform(one_of<std::string>({{"bash", "bash"}, {"zsh", "zsh"}, {"fish", "fish"}}));
  verb->callback([shell, &program] {
    const std::vector<VerbText> verbs = verbs_of(program);
    const std::string text = *shell == "bash"  ? bash_completion(verbs)
                             : *shell == "zsh" ? zsh_completion(verbs)
                                               : fish_completion(verbs);
    std::fputs(text.c_str(), stdout);
  });
}

void add_manual(CLI::App& program) {
  auto* verb = program.add_subcommand("manual", "Print the manual page");
  verb->callback([&program] {
    std::fputs(manual_page(verbs_of(program), program.get_description(), mien_version()).c_str(),
               stdout);
  });
}

}  // namespace mien::app
