#include "flexura/kinematics/inverse.h"

#include <fmt/format.h>

#include <memory>

#include "python/bindings/arm.h"
#include "python/bindings/convert.h"
#include "python/bindings/module.h"
#include "python/bindings/threads.h"

namespace flexura::python {
namespace {

InverseObjective objective_of(const std::string& name) {
  if (name == "none") return InverseObjective::none;
  if (name == "least_bending") return InverseObjective::least_bending;
  if (name == "mid_range") return InverseObjective::mid_range;
  throw py::value_error(
      fmt::format("objective: \"{}\": expected one of \"none\", \"least_bending\", \"mid_range\"", name));
}

Eigen::Vector3d triple(const Reals& values, const char* name) { return vector_of(values, 3, name); }

Eigen::Matrix3d rotation(const Reals& values) {
  if (values.ndim() != 2 || values.shape(0) != 3 || values.shape(1) != 3)
    throw py::value_error("rotation: expected an array of shape (3, 3)");
  return Eigen::Map<const RowMajor<3, 3>>(values.data());
}

ArmState start_state(const DescribedArm& arm, const Reals& given) {
  const StateArray states(given, arm.sections());
  if (!states.is_single()) throw py::value_error("start: expected one state");
  ArmState start;
  states.read(0, start);
  return start;
}

struct Settings {
  std::string objective;
  std::optional<double> tolerance;
  int max_starts;
  std::uint64_t seed;

  [[nodiscard]] InverseConfig config() const {
    InverseConfig config;
    config.objective = objective_of(objective);
    config.position_tolerance = tolerance;
    config.max_starts = max_starts;
    config.seed = seed;
    return config;
  }
};

InverseResult inverse_tip(const DescribedArm& arm, const Reals& position,
                          const std::optional<Reals>& direction, const std::optional<Reals>& given_rotation,
                          const std::optional<Reals>& start, const Settings& settings) {
  TipTarget target{.position = triple(position, "position")};
  if (direction) target.direction = triple(*direction, "direction");
  if (given_rotation) target.rotation = rotation(*given_rotation);
  InverseConfig config = settings.config();
  if (start) config.start = start_state(arm, *start);
  const py::gil_scoped_release released;
  return solve_inverse(arm.model, target, config);
}

InverseResult inverse_curve(const DescribedArm& arm, const Reals& points, const std::optional<Reals>& start,
                            const Settings& settings) {
  if (points.ndim() != 2 || points.shape(1) != 3)
    throw py::value_error("points: expected an array of shape (m, 3)");
  CurveTarget target;
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    target.points.push_back(Eigen::Map<const Eigen::Vector3d>(points.data(i, 0)));
  InverseConfig config = settings.config();
  if (start) config.start = start_state(arm, *start);
  const py::gil_scoped_release released;
  return solve_inverse(arm.model, target, config);
}

// Inverse kinematics of many positions.
py::tuple inverse_batch(const DescribedArm& arm, const Reals& positions, const std::optional<Reals>& starts,
                        const Settings& settings, std::size_t threads) {
  if (positions.ndim() != 2 || positions.shape(1) != 3)
    throw py::value_error("positions: expected an array of shape (N, 3)");
  const auto count = static_cast<std::size_t>(positions.shape(0));
  std::optional<StateArray> from;
  if (starts) from.emplace(*starts, arm.sections());
  if (from && from->count() != count) throw py::value_error("starts: expected one state per position");
  const auto sections = static_cast<py::ssize_t>(arm.sections());
  py::array_t<double> states(Sizes{positions.shape(0), sections, 3}), errors(positions.shape(0));
  py::array_t<bool> converged(positions.shape(0));
  const double* position = positions.data();
  double *state = states.mutable_data(), *error = errors.mutable_data();
  bool* is_found = converged.mutable_data();
  const InverseConfig common = settings.config();
  {
    const py::gil_scoped_release released;
    share_out(count, arm.is_shareable() ? threads : 1, [&](std::size_t begin, std::size_t end) {
      InverseConfig config = common;
      for (std::size_t i = begin; i < end; ++i) {
        if (from) from->read(i, config.start.emplace());
        const InverseResult found = solve_inverse(
            arm.model, TipTarget{.position = Eigen::Map<const Eigen::Vector3d>(position + 3 * i)}, config);
        for (std::size_t k = 0; k < arm.sections(); ++k)
          Eigen::Map<Eigen::Vector3d>{state + 3 * (arm.sections() * i + k)} << found.state.bends[k],
              found.state.stretches[k];
        error[i] = found.position_error;
        is_found[i] = found.converged();
      }
    });
  }
  return py::make_tuple(states, converged, errors);
}

}  // namespace

void bind_inverse(py::module_& module) {
  using py::arg;
  py::class_<InverseResult>(module, "InverseResult", "Result of inverse kinematics.")
      .def_property_readonly("converged", &InverseResult::converged, "Whether a solution was found.")
      .def_property_readonly(
          "reason", [](const InverseResult& result) { return name_of(result.outcome); },
          "\"converged\", \"not_reachable\", \"at_limit\" or \"no_convergence\".")
      .def_property_readonly(
          "state", [](const InverseResult& result) { return state_array(result.state); },
          "The solution, or the nearest state found, shape (sections, 3).")
      .def_property_readonly(
          "tip", [](const InverseResult& result) { return vector_array(result.tip); },
          "The tip's position in this state, m, shape (3,).")
      .def_readonly("is_proven", &InverseResult::is_proven,
                    "Whether no state within the limits reaches the target.")
      .def_readonly("position_error", &InverseResult::position_error, "Distance from the target, m.")
      .def_readonly("angle_error", &InverseResult::angle_error,
                    "Angle between the tip's and the target's orientation, rad.")
      .def_readonly("position_tolerance", &InverseResult::position_tolerance,
                    "Tolerance of position_error, m.")
      .def_readonly("iterations", &InverseResult::iterations, "Number of evaluations of the arm.")
      .def("__repr__", [](const InverseResult& result) {
        return fmt::format("<flexura.InverseResult: {}, {:.3g} m>", name_of(result.outcome),
                           result.position_error);
      });
  const py::object arm_class = module.attr("Arm");
  const auto method = [&](const char* name, auto&& function, auto&&... extra) {
    arm_class.attr(name) =
        py::cpp_function(std::forward<decltype(function)>(function), py::name(name), py::is_method(arm_class),
                         std::forward<decltype(extra)>(extra)...);
  };
  method(
      "inverse",
      [](const DescribedArm& arm, const Reals& position, const std::optional<Reals>& direction,
         const std::optional<Reals>& wanted_rotation, const std::optional<Reals>& start,
         std::string objective, std::optional<double> tolerance, int max_starts, std::uint64_t seed) {
        return inverse_tip(arm, position, direction, wanted_rotation, start,
                           {std::move(objective), tolerance, max_starts, seed});
      },
      arg("position"), arg("direction") = py::none(), arg("rotation") = py::none(), arg("start") = py::none(),
      py::kw_only(), arg("objective") = "none", arg("tolerance") = py::none(), arg("max_starts") = 400,
      arg("seed") = 1,
      "Finds a state that brings the tip to `position` (3,), m, with the z axis along `direction` (3,), or "
      "with the\n"
      "orientation `rotation` (3, 3), if given. Returns an InverseResult. `start`: state from which the "
      "search\n"
      "starts. `objective`: \"none\", \"least_bending\" or \"mid_range\". `tolerance`: of the position, m.");
  method(
      "inverse_curve",
      [](const DescribedArm& arm, const Reals& points, const std::optional<Reals>& start,
         std::string objective, std::optional<double> tolerance, int max_starts, std::uint64_t seed) {
        return inverse_curve(arm, points, start, {std::move(objective), tolerance, max_starts, seed});
      },
      arg("points"), arg("start") = py::none(), py::kw_only(), arg("objective") = "none",
      arg("tolerance") = py::none(), arg("max_starts") = 400, arg("seed") = 1,
      "Finds a state that brings the whole backbone to a polyline with vertices `points` (m, 3), m. Returns "
      "an\n"
      "InverseResult.");
  method(
      "inverse_batch",
      [](const DescribedArm& arm, const Reals& positions, const std::optional<Reals>& starts,
         std::string objective, std::optional<double> tolerance, int max_starts, std::uint64_t seed,
         std::size_t threads) {
        return inverse_batch(arm, positions, starts, {std::move(objective), tolerance, max_starts, seed},
                             threads);
      },
      arg("positions"), arg("starts") = py::none(), py::kw_only(), arg("objective") = "none",
      arg("tolerance") = py::none(), arg("max_starts") = 400, arg("seed") = 1, arg("threads") = 1,
      "Finds states that bring the tip to each of `positions` (N, 3), m. Returns the states (N, sections, "
      "3), whether\n"
      "each is a solution (N,), and the distances from the targets (N,), m.");
}

}  // namespace flexura::python
