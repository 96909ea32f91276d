#include "flexura/experiment/identify_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "flexura/base/work_progress.h"
#include "flexura/math/hash.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/identification.h"
#include "flexura/mechanics/place_record.h"
#include "flexura/mechanics/rod_modes.h"
#include "flexura/mechanics/statics.h"

namespace flexura {
namespace {

using Eigen::Index;
using Kind = RodParameter::Kind;

// Limits of the default window. It covers one oscillation, but fits several times into the record and holds
// enough samples.
constexpr double least_windows = 4, least_samples_in_window = 12;
// Misfit above which there is a note: the residual is twice what noise explains.
constexpr double large_misfit = 4;

// Returns a uniform number in (0, 1) from random bits.
double uniform_of(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; }

// Returns the period of the slowest vibration mode of the arm at rest, s; 0: no such mode.
double slowest_period(Rod rod, const RodLoads& loads) {
  for (TendonRoute& tendon : rod.tendons) tendon.friction = 0;
  RodStatics statics(rod);
  const Equilibrium rest = statics.solve({}, loads);
  if (!rest.converged() || !rest.q.allFinite()) return 0;
  RodDynamics dynamics(rod);
  const RodModes modes = rod_modes(dynamics.slopes(dynamics.rest(rest), {}, loads));
  return modes.frequencies.empty() || !(modes.frequencies[0] > 0) ? 0 : 1 / modes.frequencies[0];
}

// Returns the default length of motion in one equation, s.
double window_for(const Rod& rod, const RodLoads& loads, const std::vector<RodPlaceSample>& samples) {
  const double length = samples.back().time - samples.front().time,
               step = length / static_cast<double>(samples.size() - 1);
  const double period = slowest_period(rod, loads);
  const double desired = period > 0 ? period : length / 8;
  return std::min(length,
                  std::max(least_samples_in_window * step, std::min(desired, length / least_windows)));
}

std::vector<RodParameter> parameters_of(const Rod& rod, const IdentifySettings& settings) {
  std::vector<RodParameter> parameters;
  for (const Kind kind : {Kind::stiffness, Kind::damping})
    for (std::size_t i = 0; i < (settings.alike ? 1 : rod.sections.size()); ++i)
      parameters.push_back(
          {.kind = kind, .section = settings.alike ? std::nullopt : std::optional<std::size_t>(i)});
  if (settings.mass) parameters.push_back({.kind = Kind::mass});
  if (settings.friction) parameters.push_back({.kind = Kind::friction});
  return parameters;
}

// Returns the damping time, s, with its standard deviation, from the identified stiffness and damping. Both
// must be observable.
IdentifiedValue damping_of(const Identification& found, Index stiffness, Index damping, double spread) {
  const double f = found.values[stiffness], c = found.values[damping];
  // c is relative to the file's stiffness.
  const Eigen::Vector2d slope(-c / (f * f), 1 / f);
  Eigen::Matrix2d covariance;
  covariance << found.covariance(stiffness, stiffness), found.covariance(stiffness, damping),
      found.covariance(damping, stiffness), found.covariance(damping, damping);
  return {.name = "damping_time",
          .unit = "s",
          .is_determined = f > 0,
          .value = c / f,
          .sigma = spread * std::sqrt(std::max(0.0, slope.dot(covariance * slope)))};
}

// Returns the rod with the identified values; the other values stay nominal.
Rod identified_rod(Rod rod, const IdentifiedArm& found) {
  for (const IdentifiedValue& value : found.values) {
    if (!value.is_determined || !value.is_physical) continue;
    if (value.name == "friction") {
      for (TendonRoute& tendon : rod.tendons) tendon.friction = value.value;
      continue;
    }
    for (std::size_t i = 0; i < rod.sections.size(); ++i) {
      if (value.section && *value.section != i + 1) continue;
      RodSection& section = rod.sections[i];
      if (value.name == "damping_time") {
        section.damping_time = value.value;
      } else if (value.name == "mass_factor") {
        section.density *= value.value;
        if (section.mass_per_length) *section.mass_per_length *= value.value;
        for (PointMass& mass : section.masses) mass.mass *= value.value;
      } else {
        const double factor = value.value / value.nominal;
        section.youngs_modulus *= factor, section.shear_modulus *= factor;
        if (section.stiffness) *section.stiffness *= factor;
      }
    }
  }
  return rod;
}

// Words for the name of a value, with its unit.
std::string words_of(const std::string& name) {
  if (name == "youngs_modulus") return "Young's modulus, Pa";
  if (name == "stiffness_factor") return "stiffness, factor";
  if (name == "friction") return "tendon friction, coefficient";
  return name == "damping_time" ? "damping time, s" : "mass, factor";
}

// Returns the note on a determined value that no material has.
std::string unphysical_note(const IdentifiedValue& value, const IdentifiedArm& found) {
  const bool can_be_zero = value.name == "damping_time" || value.name == "friction";
  // Within two standard deviations of the range the value says only that it is small.
  const std::string why =
      value.value + 2 * value.sigma > 0
          ? "the motion hardly excites this parameter, or its value is too small to be observed"
          : fmt::format(
                "the sampling interval ({:.3g} ms) is too long, or the file's arm "
                "differs from the true arm in other values too",
                1e3 * found.step);
  return fmt::format("{} = {:.4g} +- {:.2g} is outside its physical range ({}): {}", label_of(value),
                     value.value, value.sigma, can_be_zero ? "0 or more" : "above 0", why);
}

}  // namespace

Rod identifiable_rod(const Experiment& experiment, const std::string& source) {
  if (experiment.arm.drag)
    throw input_error(source,
                      "arm.drag: the identification does not support a fluid: expected no such table");
  if (!experiment.arm.payload.empty())
    throw input_error(source,
                      "arm.payload: the identification does not support payloads: expected no such table");
  try {
    Rod rod = rod_of(experiment.arm, experiment.drive);
    // Places determine few modes: those of whole sections, not of the pieces between their disks.
    for (RodSection& section : rod.sections) section.modes.by_piece = false;
    (void)RodDynamics(rod);
    return rod;
  } catch (const std::invalid_argument& error) {
    throw input_error(source, error.what());
  }
}

// G. Box, M. Muller.
void add_noise(MeasuredMotion& motion, double noise, std::int64_t seed) {
  const auto first = static_cast<std::uint64_t>(seed);
  for (std::size_t k = 0; k < motion.samples.size(); ++k)
    for (std::size_t i = 0; i < motion.places.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const double radius = std::sqrt(-2 * std::log(uniform_of(hash(first, k, i, c, std::uint64_t{0}))));
        const double angle = 2 * std::numbers::pi * uniform_of(hash(first, k, i, c, std::uint64_t{1}));
        motion.samples[k].positions[i][static_cast<Index>(c)] += noise * radius * std::cos(angle);
      }
}

IdentifiedArm identify_arm(const ArmConfig& arm, const Rod& rod, const MeasuredMotion& motion,
                           const IdentifySettings& settings, Progress& progress) {
  const RodLoads loads = loads_of(arm);
  WorkProgress work(progress, {1, 1, 1, 1});
  const RodPlaceRecord record =
      record_of_places(rod, motion.places, motion.samples, loads, settings.noise, &work.piece(0));
  const std::vector<RodParameter> parameters = parameters_of(rod, settings);
  const double window = settings.window > 0 ? settings.window : window_for(rod, loads, motion.samples);
  const Identification found = identify(rod, parameters, record.record, {.window = window}, &work.piece(1));
  IdentifiedArm result{.values = {},
                       .samples = motion.samples.size(),
                       .places = motion.places.size(),
                       .equations = found.equations,
                       .misfit = found.misfit,
                       .noise = record.noise,
                       .rms = record.rms,
                       .step = (motion.samples.back().time - motion.samples.front().time) /
                               static_cast<double>(motion.samples.size() - 1),
                       .converged = found.converged};
  // Model error counts like noise.
  const double spread = std::sqrt(std::max(1.0, found.misfit));
  const auto count = static_cast<Index>(settings.alike ? 1 : rod.sections.size());
  const auto is_determined = [&](Index g) { return found.is_observable[static_cast<std::size_t>(g)] != 0; };
  for (Index i = 0; i < count; ++i) {
    const MaterialConfig& material = *arm.section[static_cast<std::size_t>(i)].material;
    const bool has_modulus = material.youngs_modulus.has_value() && !material.stiffness;
    const double nominal = has_modulus ? *material.youngs_modulus : 1;
    const auto section = settings.alike ? std::nullopt : std::optional<std::size_t>(i + 1);
    result.values.push_back({.name = has_modulus ? "youngs_modulus" : "stiffness_factor",
                             .unit = has_modulus ? "Pa" : "",
                             .section = section,
                             .is_determined = is_determined(i),
                             .value = nominal * found.values[i],
                             .sigma = nominal * spread * found.sigma[i],
                             .nominal = nominal});
    IdentifiedValue damping{.name = "damping_time", .unit = "s"};
    if (is_determined(i) && is_determined(count + i)) damping = damping_of(found, i, count + i, spread);
    damping.section = section;
    damping.nominal = material.damping_time;
    result.values.push_back(damping);
  }
  if (settings.mass)
    result.values.push_back({.name = "mass_factor",
                             .unit = "",
                             .is_determined = is_determined(2 * count),
                             .value = found.values[2 * count],
                             .sigma = spread * found.sigma[2 * count],
                             .nominal = 1});
  if (settings.friction) {
    const Index last = static_cast<Index>(parameters.size()) - 1;
    result.values.push_back({.name = "friction",
                             .unit = "",
                             .is_determined = is_determined(last),
                             .value = found.values[last],
                             .sigma = spread * found.sigma[last],
                             .nominal = rod.tendons.front().friction});
  }
  for (IdentifiedValue& value : result.values) {
    const bool can_be_zero = value.name == "damping_time" || value.name == "friction";
    value.is_physical = !value.is_determined || value.value > 0 || (can_be_zero && value.value == 0);
  }
  result.missed_file = places_missed(rod, motion.places, motion.samples, record, &work.piece(2));
  result.missed =
      places_missed(identified_rod(rod, result), motion.places, motion.samples, record, &work.piece(3));
  return result;
}

std::string label_of(const IdentifiedValue& value) {
  const std::string of = value.section ? fmt::format("section {}: ", *value.section) : "";
  return of + words_of(value.name);
}

Node identified_node(const IdentifiedValue& value) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  Node::Table line = {{"parameter", {}, text_node(value.name)}};
  if (value.section) line.push_back({"section", {}, {static_cast<std::int64_t>(*value.section), {}}});
  line.push_back({"observable", {}, {value.is_determined, {}}});
  line.push_back({"physical", {}, value.is_determined ? Node{value.is_physical, {}} : Node{}});
  line.push_back({"value", {}, number_node(value.is_determined ? value.value : nothing)});
  line.push_back({"sigma", {}, number_node(value.is_determined ? value.sigma : nothing)});
  line.push_back({"nominal", {}, number_node(value.nominal)});
  line.push_back({"unit", {}, text_node(value.unit)});
  return {std::move(line), {}};
}

Node identified_node(const IdentifiedArm& found) {
  return {Node::Table{{"samples", {}, {static_cast<std::int64_t>(found.samples), {}}},
                      {"places", {}, {static_cast<std::int64_t>(found.places), {}}},
                      {"equations", {}, {static_cast<std::int64_t>(found.equations), {}}},
                      {"misfit", {}, number_node(found.misfit)},
                      {"noise", {}, number_node(found.noise)},
                      {"shape_rms", {}, number_node(found.rms)},
                      {"residual_rms", {}, number_node(found.missed)},
                      {"nominal_residual_rms", {}, number_node(found.missed_file)}},
          {}};
}

std::vector<std::string> identification_notes(const IdentifiedArm& found, double noise) {
  std::vector<std::string> notes;
  // Positions off the rod's shapes by so many times their noise are those of another geometry.
  constexpr double far_off = 2;
  const bool is_off = noise > 0 && found.rms > far_off * noise;
  if (found.misfit > large_misfit)
    notes.push_back(fmt::format(
        "the identified arm does not explain the motion (misfit {:.3g}, expected about 1). The values "
        "and standard deviations may be wrong. Check the section lengths, masses, tendons and loads of the "
        "file, and the sampling interval ({:.3g} ms)",
        found.misfit, 1e3 * found.step));
  if (is_off)
    notes.push_back(fmt::format(
        "no shape of the file's arm fits the positions: the residual is {:.3g} mm (rms), the noise "
        "{:.3g} mm: check the file's section lengths and the positions' arc lengths",
        1e3 * found.rms, 1e3 * noise));
  for (const IdentifiedValue& value : found.values)
    if (value.is_determined && !value.is_physical) notes.push_back(unphysical_note(value, found));
  if (!found.converged)
    notes.emplace_back(
        "the estimate of the friction did not converge; all values are from the last iteration");
  return notes;
}

}  // namespace flexura
