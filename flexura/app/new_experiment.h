#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A commented experiment file as a starting point.
struct ExperimentTemplate {
  std::string_view kind;     ///< Name of the kind for `flexura new`.
  std::string_view meaning;  ///< Description in one line, for the help.
  std::string_view
      text;  ///< Contents of the file; FILE in the comments of the text is a placeholder for the file's name.
};

/// Returns all templates, the simplest first.
[[nodiscard]] const std::vector<ExperimentTemplate>& experiment_templates();

/// The arguments of `flexura new`.
struct NewArguments {
  std::string kind = "arm";
  std::string file;  ///< File to write; "": KIND.toml in the working folder, where KIND is the kind's name.
};

/// Writes the template and prints commands that use it. Throws InputError if the file exists.
int new_command(const NewArguments& arguments, std::ostream& out);

}  // namespace flexura
