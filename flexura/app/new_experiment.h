#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A commented experiment file to begin with.
struct ExperimentTemplate {
  std::string_view kind;     ///< As `flexura new` calls it.
  std::string_view meaning;  ///< One line for the help.
  std::string_view text;     ///< The file; FILE in its comments stands for its name.
};

/// Every template, the simplest first.
[[nodiscard]] const std::vector<ExperimentTemplate>& experiment_templates();

/// The arguments of `flexura new`.
struct NewArguments {
  std::string kind = "arm";
  std::string file;  ///< "" for the kind's name with ".toml" in the working folder.
};

/// Writes the template and prints what can be done with it. An existing file is kept: InputError.
int new_command(const NewArguments& arguments, std::ostream& out);

}  // namespace flexura
