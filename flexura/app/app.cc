#include "flexura/app/app.h"

#include <fmt/format.h>

// Only this file sees CLI11 (docs/architecture.md, "Heavy headers").
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/render.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/base/version.h"

namespace flexura {
namespace {

using Command = std::function<int()>;

void add_run(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* run = app.add_subcommand("run", "Run an experiment and write its results into a new folder");
  run->add_option("EXPERIMENT", arguments->experiment, "The experiment file (TOML)")->required();
  run->add_option("--out", arguments->out, "Folder to make for the results (default: results/NAME)")
      ->type_name("DIR");
  run->add_option("--set", arguments->sets, "Change a value: arm.section.0.length=2.5 (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  run->add_option("--seed", arguments->seed, "Seed of every random number")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1000000000000000}));
  run->add_flag("--json", arguments->json, "Print the summary as one JSON document");
  run->callback([&chosen, arguments] {
    chosen = [arguments] { return run_command(*arguments, std::cout, std::cerr); };
  });
}

void add_check(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* check =
      app.add_subcommand("check", "Say what an experiment's motions would break, touch or not reach");
  check->add_option("EXPERIMENT", arguments->experiment, "The experiment file (TOML)")->required();
  check->add_option("--set", arguments->sets, "Change a value: arm.section.0.length=2.5 (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  check->add_flag("--json", arguments->json, "Print what was found as one JSON document");
  check->callback(
      [&chosen, arguments] { chosen = [arguments] { return check_command(*arguments, std::cout); }; });
}

// The commands that answer lines about an arm.
void add_answers(CLI::App& app, Command& chosen, const std::string& name, const std::string& meaning,
                 int (*command)(const std::string&, std::istream&, std::ostream&)) {
  auto file = std::make_shared<std::string>();
  CLI::App* answers = app.add_subcommand(name, meaning + ": JSON lines in, JSON lines out");
  answers->add_option("ARM", *file, "A file with [arm] (an experiment, or an arm alone)")->required();
  answers->callback(
      [&chosen, file, command] { chosen = [file, command] { return command(*file, std::cin, std::cout); }; });
}

void add_render(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* render = app.add_subcommand("render", "Write the image that a camera takes of an experiment");
  render->add_option("EXPERIMENT", arguments->experiment, "The experiment file (TOML)")->required();
  render->add_option("--camera", arguments->camera, "The camera's name")->type_name("NAME")->required();
  render->add_option("--time", arguments->time, "The experiment's time, s")
      ->type_name("T")
      ->capture_default_str();
  render->add_option("--out", arguments->out, "The image file to write (.png)")
      ->type_name("FILE")
      ->required();
  render->add_flag("--model", arguments->model,
                   "The rig as the tasks believe it to be, whatever [truth] says");
  render->add_flag("--truth", arguments->truth,
                   "Write beside it what it shows, from the geometry: depth, labels, curves");
  render->add_option("--set", arguments->sets, "Change a value: camera.0.initial.pan_deg=2 (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  render->callback(
      [&chosen, arguments] { chosen = [arguments] { return render_command(*arguments, std::cout); }; });
}

void add_export(CLI::App& app, Command& chosen) {
  auto results = std::make_shared<std::string>();
  auto format = std::make_shared<std::string>("csv");
  CLI::App* command = app.add_subcommand("export", "Write a run's log in another format");
  command->add_option("RESULTS", *results, "A folder made by `flexura run`")->required();
  command->add_option("--to", *format, "The format")->check(CLI::IsMember({"csv", "mp4"}))->required();
  command->callback([&chosen, results, format] {
    chosen = [results, format] { return export_command(*results, *format, std::cout, std::cerr); };
  });
}

void add_schema(CLI::App& app, Command& chosen) {
  auto format = std::make_shared<std::string>("json");
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of experiment files");
  command->add_option("--format", *format, "json, or markdown for a reference page")
      ->check(CLI::IsMember({"json", "markdown"}))
      ->capture_default_str();
  command->callback([&chosen, format] { chosen = [format] { return schema_command(*format, std::cout); }; });
}

// CLI11 would only say that it misses a command. Tells it on stderr.
bool is_unknown_command(const CLI::App& app, std::string_view word) {
  if (word.starts_with('-')) return false;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::count(names, word) > 0) return false;
  const std::string_view near = nearest_name(word, names);
  std::cerr << fmt::format("flexura: there is no command {}{} (see flexura --help)\n",
                           Node{std::string(word), {}}.brief(),
                           near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
  return true;
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app("Flexura: a simulator for hyperredundant robots under visual control", "flexura");
  app.set_version_flag("--version", std::string(version()));
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return fmt::format("flexura: {} (see flexura --help)\n", error.what());
  });
  Command chosen;
  add_run(app, chosen);
  add_check(app, chosen);
  add_answers(app, chosen, "fk", "Forward kinematics", forward_command);
  add_answers(app, chosen, "ik", "Inverse kinematics", inverse_command);
  add_render(app, chosen);
  add_export(app, chosen);
  add_schema(app, chosen);
  if (argc > 1 && is_unknown_command(app, argv[1])) return exit_bad_input;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_done : exit_bad_input;
  }
  return chosen();
}

}  // namespace

int run_app(int argc, const char* const* argv) noexcept {
  try {
    const int status = parse_and_run(argc, argv);
    std::cout.flush();
    if (std::ferror(stdin) != 0) throw std::runtime_error("cannot read the standard input");
    if (!std::cout) throw std::runtime_error("cannot write to the standard output");
    return status;
  } catch (const InputError& error) {
    std::cerr << error.what() << '\n';
    return exit_bad_input;
  } catch (const std::exception& error) {
    std::cerr << "flexura: " << error.what() << '\n';
    return exit_system_failure;
  }
}

}  // namespace flexura
