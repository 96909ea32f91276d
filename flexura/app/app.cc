#include "flexura/app/app.h"

#include <fmt/format.h>

// Only this file sees CLI11 (docs/architecture.md, "Heavy headers").
#include <CLI/CLI.hpp>
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

#include "flexura/app/commands.h"
#include "flexura/app/estimate.h"
#include "flexura/app/intrinsics.h"
#include "flexura/app/measure.h"
#include "flexura/app/render.h"
#include "flexura/app/view.h"
#include "flexura/base/node.h"
#include "flexura/base/one_line.h"
#include "flexura/base/source.h"
#include "flexura/base/version.h"
#include "flexura/sim/simulation_error.h"

namespace flexura {
namespace {

using Command = std::function<int()>;

void add_viewer_options(CLI::App& command, ViewerArguments& viewer) {
  command.add_option("--port", viewer.port, "Port of the viewer (default: 8421, or any that is free)")
      ->type_name("N")
      ->check(CLI::Range(std::uint16_t{0}, std::uint16_t{65535}));
  command.add_flag("!--no-browser", viewer.browser, "Print the address, and open no browser");
  command.add_option("--address", viewer.address, "Address of the interface to listen on")
      ->type_name("A")
      ->capture_default_str();
  command.add_option("--name", viewer.names, "A further name by which the viewer is called (repeatable)")
      ->type_name("HOST")
      ->allow_extra_args(false);
}

void add_view(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<ViewArguments>();
  CLI::App* view = app.add_subcommand("view", "See a rig or a run in the browser, and move what moves");
  view->add_option("WHAT", arguments->what,
                   "An experiment file, or a folder made by `flexura run` (default: the paper's arm)");
  add_viewer_options(*view, arguments->viewer);
  view->callback([&chosen, arguments] {
    chosen = [arguments] { return view_command(*arguments, std::cout, std::cerr); };
  });
}

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
  auto viewer = std::make_shared<ViewerArguments>();
  auto is_viewed = std::make_shared<bool>(false);
  CLI::Option* view = run->add_flag("--view", *is_viewed, "Watch the run in the browser");
  add_viewer_options(*run, *viewer);
  for (const char* option : {"--port", "--no-browser", "--address", "--name"})
    run->get_option(option)->needs(view);
  run->callback([&chosen, arguments, viewer, is_viewed] {
    if (*is_viewed) arguments->viewer = *viewer;
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
  check->callback([&chosen, arguments] {
    chosen = [arguments] { return check_command(*arguments, std::cout, std::cerr); };
  });
}

constexpr const char* statics_footer =
    "A line says what pulls, or where the arm shall be; all in the frame of the arm's base:\n"
    "  {\"tensions\":[4,0,0,0,2,0],\"tip_force\":[0,0,-0.1],\"at\":[0.1,0.2]}\n"
    "  {\"displacements\":[0.004,0,0,0,0.002,0],\"gravity\":[0,0,-9.81]}\n"
    "  {\"target\":{\"tip\":[0.1,0.1,0.3],\"direction\":[0,0,1],\"most_tension\":20}}\n"
    "A target has tip, direction or rotation [w,x,y,z], or shape\n"
    "[{\"at\":0.2,\"position\":[x,y,z]},...]; the answer has the tensions of least effort,\n"
    "whether it was reached, and the residual, m.";

// The commands that answer lines about an arm.
void add_answers(CLI::App& app, Command& chosen, const std::string& name, const std::string& meaning,
                 int (*command)(const std::string&, std::istream&, std::ostream&),
                 const std::string& footer = "") {
  auto file = std::make_shared<std::string>();
  CLI::App* answers = app.add_subcommand(name, meaning + ": JSON lines in, JSON lines out");
  answers->add_option("ARM", *file, "A file with [arm] (an experiment, or an arm alone)")->required();
  answers->footer(footer);
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

void add_threshold_options(CLI::App& command, ThresholdArguments& threshold) {
  command.add_option("--threshold", threshold.method, "otsu (default), two_mode, by_block or fixed")
      ->type_name("METHOD");
  command.add_option("--level", threshold.level, "The fixed threshold, 0 to 255")->type_name("LEVEL");
  command.add_option("--figure", threshold.figure, "dark or bright (default: what is not at the border)")
      ->type_name("SIDE");
}

void add_measure(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<MeasureArguments>();
  CLI::App* measure =
      app.add_subcommand("measure", "Find the arm, its markers, a circle or the etalon in pictures");
  measure
      ->add_option("IMAGE", arguments->images,
                   "Pictures: PNG, JPEG, TIFF or PNM, up to 16 bits, gray or colour")
      ->required();
  measure->add_option("--what", arguments->what, "arm, etalon, circle or markers")
      ->type_name("WHAT")
      ->capture_default_str();
  measure
      ->add_option("--camera", arguments->camera, "The measured cameras (TOML): one, or one for each picture")
      ->type_name("FILE");
  measure->add_option("--radius", arguments->radius, "The arm's radius, m: then depths are told too")
      ->type_name("R");
  measure
      ->add_option("--gamma", arguments->gamma,
                   "Values are light to the power 1/G: of most cameras' files 2.2")
      ->type_name("G");
  add_threshold_options(*measure, arguments->threshold);
  measure->add_option("--base", arguments->base, "A place near the arm's base, px: U,V")
      ->type_name("U,V")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(2);
  measure->add_option("--overlay", arguments->overlay, "Draw what is found over the picture (.png)")
      ->type_name("FILE");
  measure->callback(
      [&chosen, arguments] { chosen = [arguments] { return measure_command(*arguments, std::cout); }; });
}

void add_estimate(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<EstimateArguments>();
  CLI::App* estimate =
      app.add_subcommand("estimate", "Find the arm's shape from pictures of two or more cameras");
  estimate->add_option("IMAGE", arguments->images, "Picture files, one of each camera")->required();
  estimate->add_option("--cameras", arguments->cameras, "The measured cameras (TOML), in the pictures' order")
      ->type_name("FILE")
      ->required();
  estimate->add_option("--base", arguments->base, "Where the arm begins, m: X,Y,Z")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3);
  estimate->add_option("--length", arguments->length, "The arm's length, m")->type_name("L");
  estimate->add_option("--arm", arguments->arm, "The arm's sections, when they are known (TOML)")
      ->type_name("FILE");
  estimate
      ->add_option("--markers", arguments->markers,
                   "Where the arm's bands are: m, or shares of its length, 25%")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("S,...");
  add_threshold_options(*estimate, arguments->threshold);
  estimate->add_option("--points", arguments->points, "Of the backbone that is printed")
      ->capture_default_str();
  estimate->callback(
      [&chosen, arguments] { chosen = [arguments] { return estimate_command(*arguments, std::cout); }; });
}

void add_intrinsics(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<IntrinsicsArguments>();
  CLI::App* intrinsics = app.add_subcommand("intrinsics", "Calibrate cameras from pictures of a board");
  intrinsics->add_option("IMAGE", arguments->images, "Pictures of the board by one camera");
  intrinsics->add_option("--left", arguments->left, "Pictures by the first camera of a pair")
      ->type_name("IMAGE");
  intrinsics->add_option("--right", arguments->right, "Pictures by the second, taken together with those")
      ->type_name("IMAGE");
  intrinsics
      ->add_option("--zoom", arguments->zooms,
                   "A folder of pictures at one zoom: RATIO=, RATIO@COUNT= or @COUNT=FOLDER (repeatable)")
      ->type_name("ZOOM=FOLDER")
      ->allow_extra_args(false);
  intrinsics->add_option("--board", arguments->board, "Inner corners, or circles: COLUMNSxROWS")
      ->type_name("CxR")
      ->required();
  intrinsics->add_option("--square", arguments->square, "Side of a square, or distance of rows of circles, m")
      ->type_name("S")
      ->required();
  intrinsics->add_option("--pattern", arguments->pattern, "chessboard, circles or asymmetric-circles")
      ->type_name("PATTERN")
      ->capture_default_str();
  intrinsics->add_option("--distortion", arguments->distortion, "How many of k1, k2, p1, p2, k3 to estimate")
      ->type_name("N")
      ->capture_default_str();
  intrinsics->add_option("--hold-out", arguments->hold_out, "Leave every Nth view out of the fit, as a check")
      ->type_name("N");
  intrinsics->add_option("--name", arguments->names, "The camera's name; twice for a pair")
      ->type_name("NAME")
      ->allow_extra_args(false);
  intrinsics->add_option("--position", arguments->position, "Of the first camera in the world, m: X,Y,Z")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3);
  intrinsics->add_option("--rotation", arguments->rotation, "Of the first camera in the world: W,X,Y,Z")
      ->type_name("W,X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(4);
  intrinsics->add_option("--out", arguments->out, "Write a file of measured cameras (.toml)")
      ->type_name("FILE");
  intrinsics->add_option("--rig", arguments->rig, "Write a file that experiments include (.toml)")
      ->type_name("FILE");
  intrinsics->add_option("--rig-from", arguments->rig_from, "An experiment whose cameras the rig file takes")
      ->type_name("EXPERIMENT");
  intrinsics->callback(
      [&chosen, arguments] { chosen = [arguments] { return intrinsics_command(*arguments, std::cout); }; });
}

// CLI11 would only say that it misses a command. Tells it on stderr.
bool is_unknown_command(const CLI::App& app, std::string_view word) {
  if (word.starts_with('-')) {
    if (app.get_option_no_throw(std::string(word)) != nullptr) return false;
    std::cerr << fmt::format("flexura: there is no option {} before a command (see flexura --help)\n",
                             Node{std::string(word), {}}.brief());
    return true;
  }
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::count(names, word) > 0) return false;
  const std::string_view near = nearest_name(word, names);
  std::cerr << fmt::format("flexura: there is no command {}{} (see flexura --help)\n",
                           Node{std::string(word), {}}.brief(),
                           near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
  return true;
}

// What a script gives whose variable is not set. CLI11 would take it for nothing, or for 0.
std::string refuse_empty(const std::string& value) { return value.empty() ? "expected no empty text" : ""; }

void refuse_empty_values(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0) option->check(refuse_empty);
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app("Flexura: a simulator for hyperredundant robots under visual control", "flexura");
  app.set_version_flag("--version", std::string(version()));
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* whole, const CLI::Error& error) {
    const auto used = whole->get_subcommands();
    const std::string command = used.empty() ? "" : used.front()->get_name() + " ";
    return fmt::format("flexura: {} (see flexura {}--help)\n", one_line(error.what()), command);
  });
  Command chosen;
  add_run(app, chosen);
  add_check(app, chosen);
  add_view(app, chosen);
  add_answers(app, chosen, "fk", "Forward kinematics", forward_command);
  add_answers(app, chosen, "ik", "Inverse kinematics", inverse_command);
  add_answers(app, chosen, "statics", "Equilibrium of an elastic arm", statics_command, statics_footer);
  add_answers(app, chosen, "linearise", "Motion of an elastic arm around its equilibrium", linearise_command);
  add_render(app, chosen);
  add_measure(app, chosen);
  add_estimate(app, chosen);
  add_intrinsics(app, chosen);
  add_export(app, chosen);
  add_schema(app, chosen);
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
  // A limit of the size of files is told as a full disk is.
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
