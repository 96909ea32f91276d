#include "flexura/app/new_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <ostream>

#include "embedded/arm_toml.h"
#include "embedded/calibration_toml.h"
#include "embedded/cameras_toml.h"
#include "embedded/servo_toml.h"
#include "embedded/tendons_toml.h"
#include "flexura/app/commands.h"
#include "flexura/app/words.h"
#include "flexura/base/source.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

// Quotes a file name for a shell.
std::string shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return (std::isalnum(c) != 0) ||
           std::string_view("_-./").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
  return quoted + "'";
}

// Puts the file's name into the commands in a template's comments.
std::string for_file(std::string text, const std::string& file) {
  constexpr std::string_view placeholder = "FILE";
  const std::string name = file.find('\n') == std::string::npos ? shell_word(file) : std::string(placeholder);
  std::size_t at = 0;
  while ((at = text.find(placeholder, at)) != std::string::npos) {
    text.replace(at, placeholder.size(), name);
    at += name.size();
  }
  return text;
}

}  // namespace

const std::vector<ExperimentTemplate>& experiment_templates() {
  static const std::vector<ExperimentTemplate> templates{
      {"arm", "an arm of two sections and two motions", embedded::arm_toml},
      {"cameras", "the arm, seen by two cameras", embedded::cameras_toml},
      {"servo", "two cameras control the shape of the arm", embedded::servo_toml},
      {"calibration", "two cameras are calibrated with the arm", embedded::calibration_toml},
      {"tendons", "an elastic arm bent by tendons", embedded::tendons_toml},
  };
  return templates;
}

int new_command(const NewArguments& arguments, std::ostream& out) {
  const auto& templates = experiment_templates();
  const auto chosen = std::ranges::find(templates, arguments.kind, &ExperimentTemplate::kind);
  if (chosen == templates.end()) {
    std::string kinds;
    for (const ExperimentTemplate& one : templates)
      kinds += fmt::format("{}\"{}\"", kinds.empty() ? "" : ", ", one.kind);
    throw input_error("KIND", fmt::format("\"{}\": expected one of {}", arguments.kind, kinds));
  }
  const std::string file = arguments.file.empty() ? fmt::format("{}.toml", chosen->kind) : arguments.file;
  if (!is_missing(file))
    throw input_error(file, "the file exists, and is not overwritten: expected the name of a new file");
  write_new_file(file, for_file(std::string(chosen->text), file));
  print_line(out, "wrote", fmt::format("{} ({})", file, chosen->meaning));
  print_line(out, "see it", "flexura view " + shell_word(file));
  print_line(out, "run it", "flexura run " + shell_word(file));
  return exit_done;
}

}  // namespace flexura
