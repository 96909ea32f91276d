#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "flexura/app/program_help.h"

namespace flexura {
namespace {

std::vector<std::string> long_names(const CommandHelp& command) {
  std::vector<std::string> names;
  for (const OptionHelp& option : command.options)
    std::ranges::copy_if(option.names, std::back_inserter(names),
                         [](const std::string& name) { return name.starts_with("--"); });
  return names;
}

std::vector<std::string> command_names(const ProgramHelp& help) {
  std::vector<std::string> names;
  std::ranges::transform(help.commands, std::back_inserter(names), &CommandHelp::name);
  return names;
}

// Returns the bash statement that offers values. File names may contain spaces, so each line is one name.
std::string bash_reply(const OptionHelp& option) {
  switch (option.takes) {
    case Takes::choice:
      return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", fmt::join(option.choices, " "));
    case Takes::experiment:
      return R"(IFS=$'\n' COMPREPLY=($(compgen -f -X '!*.toml' -- "$word"; compgen -d -- "$word")))";
    case Takes::folder:
      return R"(IFS=$'\n' COMPREPLY=($(compgen -d -- "$word")))";
    case Takes::file:
      return R"(IFS=$'\n' COMPREPLY=($(compgen -f -- "$word")))";
    case Takes::text:
    case Takes::nothing:
      break;
  }
  return "";
}

// Returns the part of an argument of zsh's _arguments that completes a value.
std::string zsh_action(const OptionHelp& option) {
  switch (option.takes) {
    case Takes::choice:
      return fmt::format(":{}:({})", option.value, fmt::join(option.choices, " "));
    case Takes::experiment:
      return fmt::format(":{}:_files -g \"*.toml\"", option.value);
    case Takes::folder:
      return fmt::format(":{}:_files -/", option.value);
    case Takes::file:
      return fmt::format(":{}:_files", option.value);
    case Takes::text:
      return fmt::format(":{}: ", option.value);
    case Takes::nothing:
      break;
  }
  return "";
}

// Escapes a text within single quotes in zsh's _arguments, where brackets and colons have a meaning.
std::string zsh_text(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'') {
      quoted += R"('\'')";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted;
}

}  // namespace

std::string bash_completion(const ProgramHelp& help) {
  std::string script = fmt::format(
      "# bash completion of {0} {1}: source this file, or put it into\n"
      "# ~/.local/share/bash-completion/completions/{0}\n"
      "_{0}() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  local IFS=$' \\t\\n'\n"
      "  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)); then\n"
      "    COMPREPLY=($(compgen -W '{2} --help --version' -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}} $before\" in\n",
      help.name, help.version, fmt::join(command_names(help), " "));
  for (const CommandHelp& command : help.commands)
    for (const OptionHelp& option : command.options) {
      if (option.takes == Takes::nothing) continue;
      const std::string words = bash_reply(option);
      for (const std::string& name : option.names)
        script += fmt::format("    '{} {}')\n{}      return\n      ;;\n", command.name, name,
                              words.empty() ? "" : fmt::format("      {}\n", words));
    }
  script += "  esac\n  case ${COMP_WORDS[1]} in\n";
  for (const CommandHelp& command : help.commands) {
    script += fmt::format(
        "    {})\n      if [[ $word == -* ]]; then\n"
        "        COMPREPLY=($(compgen -W '{}' -- \"$word\"))\n",
        command.name, fmt::join(long_names(command), " "));
    const std::string words = command.positionals.empty() ? "" : bash_reply(command.positionals.front());
    if (!words.empty()) script += fmt::format("      else\n        {}\n", words);
    script += "      fi\n      ;;\n";
  }
  return script + fmt::format("  esac\n}}\ncomplete -o filenames -F _{0} {0}\n", help.name);
}

std::string zsh_completion(const ProgramHelp& help) {
  std::string script = fmt::format(
      "#compdef {0}\n"
      "# zsh completion of {0} {1}: put it as _{0} into a folder of $fpath.\n"
      "_{0}() {{\n"
      "  local -a commands=(\n",
      help.name, help.version);
  for (const CommandHelp& command : help.commands)
    script += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.meaning));
  script +=
      "  )\n  if ((CURRENT == 2)); then\n    _describe command commands\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  ((CURRENT--))\n  case $command in\n";
  for (const CommandHelp& command : help.commands) {
    script += fmt::format("    {})\n      _arguments", command.name);
    for (const OptionHelp& option : command.options)
      for (const std::string& name : option.names)
        script += fmt::format(" \\\n        '*{}[{}]{}'", name, zsh_text(option.meaning), zsh_action(option));
    for (const OptionHelp& positional : command.positionals)
      script += fmt::format(" \\\n        '*{}'", zsh_action(positional));
    script += "\n      ;;\n";
  }
  return script + fmt::format(
                      "  esac\n}}\nif [[ $funcstack[1] == _{0} ]]; then _{0} \"$@\"; else compdef _{0} "
                      "{0}; fi\n",
                      help.name);
}

}  // namespace flexura
