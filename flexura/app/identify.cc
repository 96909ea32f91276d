#include "flexura/app/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/app/words.h"
#include "flexura/experiment/experiment.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

std::string distance_words(double metres) {
  constexpr double most = 100;  // In m; beyond, the computed motion has blown up.
  return metres < most ? fmt::format("{:.2f} mm", 1e3 * metres) : "too large to compute";
}

void print_table(const IdentifiedArm& found, std::ostream& out) {
  out << fmt::format("{:<34}{:>12}{:>12}{:>12}\n", "", "identified", "+-", "in the file");
  for (const IdentifiedValue& value : found.values) {
    out << fmt::format("{:<34}", label_of(value));
    out << (value.is_determined ? fmt::format("{:>12.5g}{:>12.2g}", value.value, value.sigma)
                                : fmt::format("{:>24}", "not observable in this motion"));
    out << fmt::format("{:>12.5g}{}\n", value.nominal, value.is_physical ? "" : "  not physical");
  }
  out << fmt::format(
      "{} positions at {} times; the rod's strain modes fit them within {} (rms); misfit {:.2f}\n",
      found.places, found.samples, distance_words(found.rms), found.misfit);
  out << fmt::format(
      "distance from the measured motion, simulated with the measured tensions: the file's arm {} (rms), the "
      "identified arm {}\n",
      distance_words(found.missed_file), distance_words(found.missed));
}

void check(const IdentifyArguments& arguments) {
  for (const auto& [option, value] : {std::pair{"--from", arguments.from}, std::pair{"--to", arguments.to}})
    if (value && !std::isfinite(*value))
      throw input_error(option, fmt::format("{}: expected a time, s", *value));
  if (arguments.from && arguments.to && !(*arguments.from < *arguments.to))
    throw input_error("--from", fmt::format("{} s is not before --to, {} s: expected an earlier time",
                                            *arguments.from, *arguments.to));
  const auto is_good = [](double value) { return value > 0 && std::isfinite(value); };
  if (arguments.noise_mm && !is_good(*arguments.noise_mm))
    throw input_error("--noise-mm", fmt::format("{}: expected a number above 0", *arguments.noise_mm));
  if (arguments.window && !is_good(*arguments.window))
    throw input_error("--window", fmt::format("{}: expected a number above 0", *arguments.window));
}

}  // namespace

int identify_command(const IdentifyArguments& arguments, std::ostream& out, std::ostream& err) {
  const Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, arguments.seed});
  check(arguments);
  const Rod rod = identifiable_rod(experiment, arguments.experiment);
  if (arguments.friction && rod.tendons.empty())
    throw input_error("--friction", "the arm has no tendons: expected an arm with tendons");
  MeasuredMotion motion = read_motion(arguments.motion, experiment, rod, {arguments.from, arguments.to});
  for (const std::string& note : motion.notes) err << "note: " << note << '\n';
  const double noise = arguments.noise_mm.value_or(0) * 1e-3;
  if (motion.is_logged && noise > 0) add_noise(motion, noise, experiment.seed);
  IdentifiedArm found;
  TerminalProgress progress(err);
  try {
    found = identify_arm(experiment.arm, rod, motion,
                         {.noise = noise,
                          .window = arguments.window.value_or(0),
                          .mass = arguments.mass,
                          .friction = arguments.friction,
                          .alike = arguments.alike},
                         progress);
  } catch (const std::invalid_argument& error) {
    throw input_error(arguments.motion, error.what());
  }
  progress.clear();
  for (const std::string& note : identification_notes(found, noise)) err << "note: " << note << '\n';
  if (arguments.json) {
    for (const IdentifiedValue& value : found.values) out << write_json(identified_node(value)) << '\n';
    out << write_json(identified_node(found)) << '\n';
  } else {
    print_table(found, out);
  }
  return std::ranges::any_of(found.values, &IdentifiedValue::is_determined) ? exit_done : exit_missed;
}

}  // namespace flexura
