#include "flexura/app/app.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/app/command_line.h"
#include "flexura/app/commands.h"
#include "flexura/app/compare.h"
#include "flexura/app/devices.h"
#include "flexura/app/dry_run.h"
#include "flexura/app/identify.h"
#include "flexura/app/jog.h"
#include "flexura/app/new_experiment.h"
#include "flexura/app/rehearse.h"
#include "flexura/app/view.h"
#include "flexura/base/node.h"
#include "flexura/base/one_line.h"
#include "flexura/base/source.h"
#include "flexura/base/version.h"
#include "flexura/sim/simulation_error.h"

namespace flexura {
namespace {

void add_viewer_options(CLI::App& command, ViewerArguments& viewer) {
  command
      .add_option("--port", viewer.port, "Port of the viewer, 0 to 65535 (default: 8421, or any free port)")
      ->type_name("N")
      ->check(CLI::Range(std::uint16_t{0}, std::uint16_t{65535}).description(""));
  command.add_flag_callback(
      "--no-browser", [&viewer] { viewer.browser = false; }, "Print the address without opening a browser");
  command
      .add_option("--address", viewer.address, "Address of the interface to listen on (default: 127.0.0.1)")
      ->type_name("A");
  command.add_option("--name", viewer.names, "Further host name of the viewer's address (repeatable)")
      ->type_name("HOST")
      ->allow_extra_args(false);
}

void add_new(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<NewArguments>();
  std::string meaning = "Write a commented experiment file as a starting point";
  CLI::App* command = add_command(app, "new", command_group::experiments, meaning,
                                  "flexura new servo\nflexura run servo.toml --view");
  std::vector<std::string> kinds;
  std::string explained = "Kind of the experiment (default: arm)";
  for (const ExperimentTemplate& one : experiment_templates()) {
    kinds.emplace_back(one.kind);
    explained += fmt::format("\n{}: {}", one.kind, one.meaning);
  }
  command->add_option("KIND", arguments->kind, explained)
      ->type_name(fmt::format("{}", fmt::join(kinds, "|")));
  command->add_option("--out", arguments->file, "The new file (default: KIND.toml)")->type_name("FILE");
  command->callback(
      [&chosen, arguments] { chosen = [arguments] { return new_command(*arguments, std::cout); }; });
}

void add_view(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<ViewArguments>();
  CLI::App* view = add_command(app, "view", command_group::experiments,
                               "Show a rig, a run, a campaign or pictures in the browser, and move the "
                               "simulated rig interactively",
                               "flexura view experiment.toml\nflexura view results/experiment\n"
                               "flexura view results/campaign.db\nflexura view photo.png");
  view->add_option(
          "WHAT", arguments->what,
          "An experiment file, a folder made by `flexura run`, a file made by `flexura campaign`, or "
          "picture files (default: the paper's arm)")
      ->type_name("");
  add_viewer_options(*view, arguments->viewer);
  view->callback([&chosen, arguments] {
    chosen = [arguments] { return view_command(*arguments, std::cout, std::cerr); };
  });
}

void add_experiment_argument(CLI::App& command, std::string& experiment) {
  command.add_option("EXPERIMENT", experiment, "The experiment file (TOML)")->type_name("")->required();
}

void add_run(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* run = add_command(
      app, "run", command_group::experiments, "Run an experiment and write its results into a new folder",
      "flexura run experiment.toml\n"
      "flexura run experiment.toml --set arm.section.0.length=0.25 --seed 7 --out trial\n"
      "flexura run laboratory.toml --dry-run\n"
      "flexura run --from results/campaign.db --row 17");
  add_experiment_argument(*run, arguments->experiment);
  run->get_option("EXPERIMENT")->required(false);
  CLI::Option* from =
      run->add_option("--from", arguments->from, "Replay a run of `flexura campaign` with these results")
          ->type_name("FILE")
          ->excludes(run->get_option("EXPERIMENT"));
  from->needs(run->add_option("--row", arguments->row, "Number of the replayed run")
                  ->type_name("N")
                  ->check(CLI::Range(std::int64_t{0}, std::int64_t{1000000000}).description(""))
                  ->needs(from));
  run->add_option("--out", arguments->out, "New folder for the results (default: results/NAME)")
      ->type_name("DIR");
  add_set_option(*run, arguments->sets);
  run->add_option("--seed", arguments->seed,
                  "Seed of every random number, 0 to 1e15 (default: the file's seed)")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1000000000000000}).description(""));
  run->add_flag("--json", arguments->json, "Print the summary as one JSON document");
  CLI::Option* dry = run->add_flag("--dry-run", arguments->dry_run,
                                   "Print what a run would send to the equipment of [rig], but send nothing");
  run->add_flag("--queries", arguments->queries, "With --dry-run: also print the queries of device states")
      ->needs(dry);
  auto viewer = std::make_shared<ViewerArguments>();
  auto is_viewed = std::make_shared<bool>(false);
  CLI::Option* view = run->add_flag("--view", *is_viewed, "Watch the run in the browser");
  add_viewer_options(*run, *viewer);
  run->add_option("--speed", arguments->speed,
                  "Speed of the watched run relative to real time; 0 means as fast as possible (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(0.0, 1000.0).description(""));
  for (const char* option : {"--port", "--no-browser", "--address", "--name", "--speed"})
    run->get_option(option)->needs(view);
  dry->excludes(view);
  dry->excludes(run->get_option("--out"));
  from->excludes(dry)->excludes(run->get_option("--seed"));
  run->callback([&chosen, arguments, viewer, is_viewed] {
    if (arguments->experiment.empty() && arguments->from.empty()) throw CLI::RequiredError("EXPERIMENT");
    if (*is_viewed) arguments->viewer = *viewer;
    chosen = [arguments] {
      return arguments->dry_run ? dry_run_command(*arguments, std::cout, std::cerr)
                                : run_command(*arguments, std::cout, std::cerr);
    };
  });
}

void add_devices(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<DevicesArguments>();
  CLI::App* devices = add_command(
      app, "devices", command_group::equipment, "List what is connected, or check the devices of a file",
      "flexura devices\nflexura devices laboratory.toml\nflexura devices --probe /dev/ttyUSB0");
  CLI::Option* file = devices
                          ->add_option("EXPERIMENT", arguments->experiment,
                                       "A file with [rig]: connect to each of its devices (default: list "
                                       "what this machine has)")
                          ->type_name("");
  CLI::Option* probe =
      devices
          ->add_option("--probe", arguments->probes,
                       "Ask what is at a serial line or an address (repeatable); all: every serial\n"
                       "line found. Opening a line resets many boards and stops their motors")
          ->type_name("LINK")
          ->allow_extra_args(false);
  add_set_option(*devices, arguments->sets);
  devices->get_option("--set")->needs(file);
  probe->excludes(file);
  devices->add_flag("--json", arguments->json, "Print one JSON document");
  devices->callback([&chosen, arguments] {
    chosen = [arguments] { return devices_command(*arguments, std::cout, std::cerr); };
  });
}

void add_jog(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<JogArguments>();
  CLI::App* jog = add_command(app, "jog", command_group::equipment,
                              "Move one axis of the equipment by a distance, within limits",
                              "flexura jog laboratory.toml motor.2 100\n"
                              "flexura jog laboratory.toml tendon.2 0.5mm\n"
                              "flexura jog laboratory.toml section.1.x -5deg\n"
                              "flexura jog laboratory.toml front.pan 2deg");
  add_experiment_argument(*jog, arguments->experiment);
  jog->add_option("AXIS", arguments->axis,
                  "motor.N (microsteps), tendon.N (mm, positive: pulled in), section.N.x or section.N.y\n"
                  "(degrees of bend), CAMERA.pan or CAMERA.tilt (degrees), CAMERA.zoom (zoom positions);\n"
                  "N counts from 1")
      ->type_name("")
      ->required();
  jog->add_option("DISTANCE", arguments->distance,
                  "How far, relative to the present position, with or without the unit of the axis;\n"
                  "not 0, within the limits of the file")
      ->type_name("")
      ->required();
  jog->add_flag("--here", arguments->here,
                "Skip homing: the arm already has its initial shape (default: rig.start decides)");
  add_set_option(*jog, arguments->sets);
  jog->add_flag("--json", arguments->json, "Print one JSON document");
  jog->callback([&chosen, arguments] {
    chosen = [arguments] { return jog_command(*arguments, std::cout, std::cerr); };
  });
}

void add_rehearse(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<RehearseArguments>();
  CLI::App* rehearse = add_command(
      app, "rehearse", command_group::experiments,
      "Simulate an experiment's equipment: motors, heads and cameras that speak the real devices' protocols",
      "flexura rehearse experiment.toml\nflexura run experiment-rehearsal.toml    (in another terminal)");
  add_experiment_argument(*rehearse, arguments->experiment);
  rehearse
      ->add_option("--out", arguments->out,
                   "Copy of the file to write, with the table [rig] (default: NAME-rehearsal.toml)")
      ->type_name("FILE");
  rehearse->add_option("--video", arguments->video, "Encoding of the cameras' videos (default: raw)")
      ->type_name("raw|jpeg|h264")
      ->check(CLI::IsMember({"raw", "jpeg", "h264"}).description(""));
  rehearse->add_option("--quality", arguments->server.quality, "Quality of JPEG, 1 to 100 (default: 90)")
      ->type_name("N")
      ->check(CLI::Range(1, 100).description(""));
  rehearse
      ->add_option("--port", arguments->server.port,
                   "Network port of the cameras' videos (default: any free port)")
      ->type_name("N")
      ->check(CLI::Range(std::uint16_t{0}, std::uint16_t{65535}).description(""));
  add_set_option(*rehearse, arguments->sets);
  rehearse->callback([&chosen, arguments] {
    chosen = [arguments] { return rehearse_command(*arguments, std::cout, std::cerr); };
  });
}

void add_check(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* check =
      add_command(app, "check", command_group::experiments,
                  "Check an experiment's motions for violated limits, contacts and unreachable targets",
                  "flexura check experiment.toml");
  add_experiment_argument(*check, arguments->experiment);
  add_set_option(*check, arguments->sets);
  check->add_flag("--json", arguments->json, "Print the findings as one JSON document");
  check->callback([&chosen, arguments] {
    chosen = [arguments] { return check_command(*arguments, std::cout, std::cerr); };
  });
}

// Adds a command that answers lines of JSON about an arm.
void add_answers(CLI::App& app, Command& chosen, const std::string& name, const std::string& meaning,
                 const std::string& example,
                 int (*command)(const std::string&, std::istream&, std::ostream&)) {
  auto file = std::make_shared<std::string>();
  CLI::App* answers = add_command(app, name, command_group::answers, meaning, example);
  answers->add_option("ARM", *file, "A file with an [arm] table: an experiment, or only the arm")
      ->type_name("")
      ->required();
  answers->callback(
      [&chosen, file, command] { chosen = [file, command] { return command(*file, std::cin, std::cout); }; });
}

void add_identify(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* identify = add_command(app, "identify", command_group::experiments,
                                   "Identify an elastic arm's stiffness and damping from a motion",
                                   "flexura identify experiment.toml results/experiment");
  identify->add_option("EXPERIMENT", arguments->experiment, "The experiment file (TOML) with the nominal arm")
      ->type_name("")
      ->required();
  identify
      ->add_option("MOTION", arguments->motion,
                   "A results folder of `flexura run`, its log (.mcap), or measured points (.csv)")
      ->type_name("")
      ->required();
  identify
      ->add_option("--from", arguments->from,
                   "Start of the part of the motion to use, s (default: the motion's start)")
      ->type_name("T");
  identify
      ->add_option("--to", arguments->to,
                   "End of the part of the motion to use, s (default: the motion's end)")
      ->type_name("T");
  identify
      ->add_option(
          "--noise-mm", arguments->noise_mm,
          "Standard deviation of measured coordinates, mm; if the motion is a log, such noise is added")
      ->type_name("N");
  identify->add_option("--window", arguments->window, "Duration of the motion in each equation, s")
      ->type_name("S");
  identify->add_flag("--alike", arguments->alike, "Assume the same material in all sections");
  identify->add_flag("--mass", arguments->mass, "Also estimate a factor on the mass");
  identify->add_flag("--friction", arguments->friction,
                     "Also estimate one friction coefficient for all tendons");
  add_set_option(*identify, arguments->sets);
  identify->add_option("--seed", arguments->seed, "Seed of the random noise, 0 to 1e15")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1000000000000000}).description(""));
  identify->add_flag("--json", arguments->json, "Print JSON lines");
  identify->callback([&chosen, arguments] {
    chosen = [arguments] { return identify_command(*arguments, std::cout, std::cerr); };
  });
}

void add_export(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = add_command(app, "export", command_group::experiments,
                                  "Write a run's log or a campaign's table in another format",
                                  "flexura export results/experiment --to csv\n"
                                  "flexura export results/experiment --to gltf --out arm.glb");
  command
      ->add_option("RESULTS", arguments->results,
                   "A folder made by `flexura run`, or a file of `flexura campaign` (csv, markdown)")
      ->type_name("")
      ->required();
  command
      ->add_option("--to", arguments->format,
                   "csv: tables; mp4, png: a film of each recorded camera (as animated PNG with png);\n"
                   "gltf: the arm's motion in three dimensions; markdown: statistics of a campaign by groups")
      ->type_name("csv|mp4|png|gltf|markdown")
      ->check(CLI::IsMember({"csv", "mp4", "png", "gltf", "markdown"}).description(""))
      ->required();
  command
      ->add_option("-o,--out", arguments->out,
                   "New file for gltf (default: RESULTS/gltf/arm.glb) or a campaign's table")
      ->type_name("FILE");
  command->callback([&chosen, arguments] {
    chosen = [arguments] { return export_command(*arguments, std::cout, std::cerr); };
  });
}

void add_compare(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* compare = add_command(app, "compare", command_group::experiments,
                                  "List the differences between the results of two runs",
                                  "flexura compare results/experiment results/experiment-2\n"
                                  "flexura compare results/a results/b --out page.html");
  compare->add_option("RESULTS_A", arguments->a, "A folder made by `flexura run`")->type_name("")->required();
  compare->add_option("RESULTS_B", arguments->b, "Another results folder")->type_name("")->required();
  compare->add_option("--out", arguments->out, "Write a page with plots of both runs (default: none)")
      ->type_name("FILE");
  compare->add_flag("--all", arguments->all, "Also list equal values");
  compare->add_flag("--json", arguments->json, "Print one JSON document");
  compare->callback([&chosen, arguments] {
    chosen = [arguments] { return compare_command(*arguments, std::cout, std::cerr); };
  });
}

void add_schema(CLI::App& app, Command& chosen) {
  auto format = std::make_shared<std::string>("json");
  auto subject = std::make_shared<std::string>("experiment");
  CLI::App* command = add_command(app, "schema", command_group::program,
                                  "Print the JSON Schema of experiment files, for editors",
                                  "flexura schema > experiment.schema.json");
  command->add_option("--format", *format, "json, or markdown for a reference page (default: json)")
      ->type_name("json|markdown")
      ->check(CLI::IsMember({"json", "markdown"}).description(""));
  command->add_option("--of", *subject, "Kind of file (default: experiment)")
      ->type_name("experiment|campaign")
      ->check(CLI::IsMember({"experiment", "campaign"}).description(""));
  command->callback([&chosen, format, subject] {
    chosen = [format, subject] { return schema_command(*format, *subject, std::cout); };
  });
}

// Adds the commands that print completion scripts and the manual page.
void add_helpers(CLI::App& app, Command& chosen) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion =
      add_command(app, "completion", command_group::program, "Print the completion script of a shell",
                  "source <(flexura completion bash)");
  completion->add_option("SHELL", *shell, "The shell")
      ->type_name("bash|zsh")
      ->check(CLI::IsMember({"bash", "zsh"}).description(""))
      ->required();
  completion->callback([&app, &chosen, shell] {
    chosen = [&app, shell] {
      const ProgramHelp help = program_help(app);
      std::cout << (*shell == "bash" ? bash_completion(help) : zsh_completion(help));
      return exit_done;
    };
  });
  CLI::App* manual = add_command(app, "man", command_group::program, "Print the manual page",
                                 "flexura man > flexura.1\nman ./flexura.1");
  manual->callback([&app, &chosen] {
    chosen = [&app] {
      std::cout << manual_page(program_help(app));
      return exit_done;
    };
  });
}

// Reports an unknown command on stderr with the nearest name; CLI11 would only report a missing one.
bool is_unknown_command(const CLI::App& app, std::string_view word) {
  if (word.starts_with('-')) {
    if (app.get_option_no_throw(std::string(word)) != nullptr) return false;
    std::cerr << fmt::format("flexura: unknown option {} before the command (see flexura --help)\n",
                             Node{std::string(word), {}}.brief());
    return true;
  }
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::count(names, word) > 0) return false;
  const std::string_view near = nearest_name(word, names);
  std::cerr << fmt::format("flexura: unknown command {}{} (see flexura --help)\n",
                           Node{std::string(word), {}}.brief(),
                           near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
  return true;
}

// Rejects empty values, which come from scripts with unset variables. CLI11 would read one as no value, or as
// 0.
std::string refuse_empty(const std::string& value) {
  return value.empty() ? "empty text: expected at least one character" : "";
}

void refuse_empty_values(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0) option->check(refuse_empty);
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app("Simulator of tentacle (continuum) robots under visual control", "flexura");
  app.set_version_flag("--version", std::string(version()), "Print the version");
  app.set_help_flag("-h,--help", "Print this help; `flexura COMMAND --help` explains a command");
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* whole, const CLI::Error& error) {
    const auto used = whole->get_subcommands();
    const std::string command = used.empty() ? "" : used.front()->get_name() + " ";
    return fmt::format("flexura: {} (see flexura {}--help)\n", one_line(error.what()), command);
  });
  Command chosen;
  add_new(app, chosen);
  add_view(app, chosen);
  add_check(app, chosen);
  add_run(app, chosen);
  add_rehearse(app, chosen);
  add_campaign_commands(app, chosen);
  add_compare(app, chosen);
  add_export(app, chosen);
  add_devices(app, chosen);
  add_jog(app, chosen);
  add_answers(app, chosen, "fk", "Forward kinematics: from bends to the tip and the backbone",
              R"(echo '{"bends":[[0.5,0],[0,0.5]]}' | flexura fk arm.toml)", forward_command);
  add_answers(app, chosen, "ik", "Inverse kinematics: from a target of the tip to bends",
              R"(echo '{"position":[0.2,0.45,0.1]}' | flexura ik arm.toml)", inverse_command);
  add_answers(app, chosen, "statics",
              "Equilibrium of an elastic arm under tensions and loads, or tensions for a target",
              R"(echo '{"tensions":[4,0,0,2,0,0]}' | flexura statics tendons.toml
echo '{"target":{"tip":[0.1,0.1,0.36]}}' | flexura statics tendons.toml)",
              statics_command);
  add_answers(app, chosen, "linearise", "Linear model of an elastic arm's motion around its equilibrium",
              R"(echo '{"tensions":[4,0,0,2,0,0]}' | flexura linearise tendons.toml)", linearise_command);
  add_identify(app, chosen);
  add_picture_commands(app, chosen);
  add_schema(app, chosen);
  add_helpers(app, chosen);
  refuse_empty_values(app);
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
  // Ignoring the signal makes a file size limit report an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int status = parse_and_run(argc, argv);
    std::cout.flush();
    if (std::ferror(stdin) != 0) throw std::runtime_error("cannot read the standard input");
    if (!std::cout) throw std::runtime_error("cannot write to the standard output");
    return status;
  } catch (const InputError& error) {
    std::cerr << error.what() << '\n';
    return exit_bad_input;
  } catch (const SimulationError& error) {
    std::cerr << "flexura: " << one_line(error.what()) << '\n';
    return exit_missed;
  } catch (const std::exception& error) {
    std::cerr << "flexura: " << one_line(error.what()) << '\n';
    return exit_system_failure;
  }
}

}  // namespace flexura
