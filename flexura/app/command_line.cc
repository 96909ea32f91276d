#include "flexura/app/command_line.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {
namespace {

// Returns the kind of a value, from its placeholder in the help.
Takes taken(const std::string& value) {
  if (value.find('|') != std::string::npos) return Takes::choice;
  if (value == "EXPERIMENT" || value == "ARM" || value == "WHAT" || value == "CAMPAIGN")
    return Takes::experiment;
  if (value == "FILE" || value == "IMAGE") return Takes::file;
  if (value == "DIR" || value == "RESULTS" || value == "MOTION") return Takes::folder;
  return Takes::text;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

OptionHelp option_help(const CLI::Option& option) {
  OptionHelp help;
  help.meaning = option.get_description();
  const std::string type = option.get_type_name();
  if (option.get_positional()) {
    help.names = {option.get_single_name()};
    help.value = type.find('|') == std::string::npos ? option.get_single_name() : type;
  } else {
    for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
    if (option.get_items_expected_max() > 0) help.value = type;
  }
  help.takes = help.value.empty() ? Takes::nothing : taken(help.value);
  if (help.takes == Takes::choice) help.choices = split(help.value, '|');
  return help;
}

}  // namespace

CLI::App* add_command(CLI::App& app, const std::string& name, const char* group, const std::string& meaning,
                      const std::string& example) {
  CLI::App* command = app.add_subcommand(name, meaning);
  command->group(group);
  command->set_help_flag("-h,--help", "Print this help");
  std::string footer = "Example:";
  for (const std::string& line : split(example, '\n')) footer += "\n  " + line;
  command->footer(footer);
  return command;
}

void add_set_option(CLI::App& command, std::vector<std::string>& sets) {
  command.add_option("--set", sets, "Change a value of the file: arm.section.0.length=0.25 (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

ProgramHelp program_help(const CLI::App& app) {
  ProgramHelp help;
  help.name = app.get_name();
  help.version = app.version();
  help.meaning = app.get_description();
  for (const CLI::App* command : app.get_subcommands({})) {
    CommandHelp& one = help.commands.emplace_back();
    one.name = command->get_name();
    one.group = command->get_group();
    one.meaning = command->get_description();
    // The example follows its heading, indented by two columns.
    for (const std::string& line : split(command->get_footer(), '\n'))
      if (line.starts_with("  ")) one.example += (one.example.empty() ? "" : "\n") + line.substr(2);
    for (const CLI::Option* option : command->get_options())
      (option->get_positional() ? one.positionals : one.options).push_back(option_help(*option));
  }
  return help;
}

}  // namespace flexura
