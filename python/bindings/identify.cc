#include <fmt/format.h>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/identify_arm.h"
#include "flexura/experiment/safety_nodes.h"
#include "flexura/experiment/schedule.h"
#include "python/bindings/callbacks.h"
#include "python/bindings/module.h"
#include "python/bindings/paths.h"

namespace flexura::python {
namespace {

// Returns an array of a dict that describes a motion. Throws py::value_error unless it has this many
// dimensions, and this size of the first one unless it is negative.
Reals motion_array(const py::dict& motion, const char* key, py::ssize_t dimensions, py::ssize_t size) {
  if (!motion.contains(key)) throw py::value_error(fmt::format("motion: expected the key \"{}\"", key));
  const auto array = py::cast<Reals>(motion[key]);
  if (array.ndim() != dimensions || (size >= 0 && array.shape(0) != size))
    throw py::value_error(fmt::format("motion[\"{}\"]: expected {} dimensions{}", key, dimensions,
                                      size >= 0 ? fmt::format(", the first of size {}", size) : ""));
  return array;
}

// Reads positions measured along the arm over time.
MeasuredMotion measured_motion(const py::dict& motion, const Experiment& experiment, const Rod& rod,
                               const TimeSpan& span) {
  const Reals times = motion_array(motion, "time", 1, -1);
  const py::ssize_t count = times.shape(0);
  const Reals tensions = motion_array(motion, "tensions", 2, count), s = motion_array(motion, "s", 1, -1),
              positions = motion_array(motion, "positions", 3, count);
  const py::ssize_t places = s.shape(0), tendons = static_cast<py::ssize_t>(rod.tendons.size());
  if (tensions.shape(1) != tendons)
    throw py::value_error(
        fmt::format("motion[\"tensions\"]: expected shape (N, {}), one column per tendon", tendons));
  if (positions.shape(1) != places || positions.shape(2) != 3)
    throw py::value_error(fmt::format("motion[\"positions\"]: expected shape (N, {}, 3)", places));
  MeasuredMotion read;
  for (py::ssize_t i = 0; i < places; ++i) {
    const auto place = place_at(rod, s.at(i));
    if (!place)
      throw py::value_error(fmt::format("motion[\"s\"]: {}: expected an arc length above 0 and at most {} m",
                                        s.at(i), rod.length()));
    read.places.push_back(*place);
  }
  const Pose X_BW = experiment.arm.arm().X_WB.inverse();
  for (py::ssize_t k = 0; k < count; ++k) {
    const double time = times.at(k);
    if (!span.has(time)) continue;
    RodPlaceSample sample{.time = time,
                          .positions = {},
                          .tensions = {tensions.data() + k * tendons, tensions.data() + (k + 1) * tendons}};
    for (py::ssize_t i = 0; i < places; ++i)
      sample.positions.push_back(X_BW * Eigen::Map<const Eigen::Vector3d>(positions.data(k, i, 0)));
    read.samples.push_back(std::move(sample));
  }
  return read;
}

void check_setting(const char* name, const std::optional<double>& value, bool is_positive) {
  if (value && (!std::isfinite(*value) || (is_positive && !(*value > 0))))
    throw py::value_error(
        fmt::format("{}: {}: expected a number{}", name, *value, is_positive ? " above 0" : ""));
}

py::dict identify(const Experiment& experiment, const py::object& motion, const std::optional<double>& start,
                  const std::optional<double>& end, const std::optional<double>& noise,
                  const std::optional<double>& window, bool alike, bool mass, bool friction,
                  const py::object& on_progress) {
  check_setting("start", start, false);
  check_setting("end", end, false);
  check_setting("noise", noise, true);
  check_setting("window", window, true);
  if (start && end && !(*start < *end)) throw py::value_error("start: expected a time before end");
  const Rod rod = identifiable_rod(experiment, "experiment");
  if (friction && rod.tendons.empty()) throw py::value_error("friction: expected an arm with tendons");
  const TimeSpan span{start, end};
  MeasuredMotion read;
  if (py::isinstance<py::dict>(motion)) {
    read = measured_motion(py::reinterpret_borrow<py::dict>(motion), experiment, rod, span);
  } else {
    const std::filesystem::path path = path_of(motion);
    const py::gil_scoped_release released;
    read = read_motion(path, experiment, rod, span);
  }
  if (read.is_logged && noise) add_noise(read, *noise, experiment.seed);
  const IdentifiedArm found = with_progress(on_progress, [&](Progress& progress) {
    return identify_arm(experiment.arm, rod, read,
                        {.noise = noise.value_or(0),
                         .window = window.value_or(0),
                         .mass = mass,
                         .friction = friction,
                         .alike = alike},
                        progress);
  });
  py::list values;
  for (const IdentifiedValue& value : found.values) values.append(python_value(identified_node(value)));
  py::dict result = python_value(identified_node(found));
  std::vector<std::string> notes = read.notes;
  for (std::string& note : identification_notes(found, noise.value_or(0))) notes.push_back(std::move(note));
  result["values"] = values;
  result["notes"] = py::cast(notes);
  return result;
}

py::object check(const Experiment& experiment, const py::object& on_progress) {
  return python_value(with_progress(on_progress, [&](Progress& progress) {
    return safety_node(check_experiment_safety(experiment, progress));
  }));
}

}  // namespace

void bind_identify(py::module_& module) {
  using py::arg;
  const auto none = py::none();
  const py::object experiment_class = module.attr("Experiment");
  experiment_class.attr("identify") = py::cpp_function(
      &identify, py::name("identify"), py::is_method(experiment_class), arg("motion"), py::kw_only(),
      arg("start") = none, arg("end") = none, arg("noise") = none, arg("window") = none, arg("alike") = false,
      arg("mass") = false, arg("friction") = false, arg("on_progress") = none,
      "Estimates stiffness and damping of the elastic arm from a motion, as `flexura identify`. motion: a "
      "results\n"
      "folder, log (.mcap) or table (.csv); or a dict of arrays: time (N,), s, tensions (N, tendons), N, s "
      "(m,), arc\n"
      "lengths of the measured points, m, and positions (N, m, 3) in the world, m. start, end: part of the "
      "motion, s.\n"
      "noise: standard deviation of the coordinates, m, which is added to the positions of a log. window: "
      "time of one\n"
      "equation, s. alike: all sections have the same material. mass, friction: estimate these, too. Returns "
      "a dict:\n"
      "values (dicts with parameter, section, observable, physical, value, sigma, nominal, unit), samples, "
      "places,\n"
      "equations, misfit, noise, shape_rms, residual_rms, nominal_residual_rms, m, and notes.");
  experiment_class.attr("check") = py::cpp_function(
      &check, py::name("check"), py::is_method(experiment_class), py::kw_only(), arg("on_progress") = none,
      "Checks the motions without running them, as `flexura check`. Returns a dict: safe, violation_count, "
      "groups,\n"
      "violations, caveats, notes.");
}

}  // namespace flexura::python
