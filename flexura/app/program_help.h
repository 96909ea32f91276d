#pragma once

#include <string>
#include <vector>

namespace flexura {

/// Kinds of values of options and arguments.
enum class Takes {
  nothing,     ///< A flag.
  text,        ///< Any text, such as a number or a name.
  choice,      ///< One of `OptionHelp::choices`.
  file,        ///< Any file.
  experiment,  ///< An experiment file (.toml).
  folder,
};

/// Description of one option or positional argument of a command for the help.
struct OptionHelp {
  std::vector<std::string>
      /// Names of an option, such as "-h" and "--help", or the name of a positional argument, such as
      /// "EXPERIMENT".
      names;
  std::string value;                 ///< Placeholder of the value: "DIR"; "" for a flag.
  std::string meaning;               ///< Description in one sentence.
  Takes takes = Takes::text;         ///< Kind of the value.
  std::vector<std::string> choices;  ///< Allowed words, for Takes::choice.
};

/// Description of one command for the help.
struct CommandHelp {
  std::string name;
  std::string group;    ///< Heading under which `flexura --help` lists the command.
  std::string meaning;  ///< Description in one sentence.
  std::string example;  ///< Example: lines that the user can paste into a shell.
  std::vector<OptionHelp> positionals;
  std::vector<OptionHelp> options;
};

/// Description of all commands. The program makes its help, the completion scripts and the manual page from
/// this description.
struct ProgramHelp {
  std::string name;
  std::string version;
  std::string meaning;
  std::vector<CommandHelp> commands;  ///< Commands in the order of the help.
};

/// Returns the completion script of a shell. The script does not need the package bash-completion.
[[nodiscard]] std::string bash_completion(const ProgramHelp& help);
[[nodiscard]] std::string zsh_completion(const ProgramHelp& help);

/// Returns the manual page, section 1, in the man(7) macros of roff.
[[nodiscard]] std::string manual_page(const ProgramHelp& help);

}  // namespace flexura
