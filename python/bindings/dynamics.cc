#include "flexura/mechanics/dynamics.h"

#include <fmt/format.h>

#include <memory>
#include <mutex>

#include "flexura/mechanics/rod_modes.h"
#include "python/bindings/module.h"
#include "python/bindings/rod.h"

namespace flexura::python {
namespace {

// RodDynamics has working memory, so only one thread may use it at a time. States are copied while Python's
// lock is held, because other threads may use them.
struct Dynamics {
  Dynamics(const DescribedArm& arm, const RodDynamicsConfig& config)
      : rod(arm), solver(rod.rod, config), rest(solver.rest()) {}

  // Calls function(solver) without the GIL.
  template <class Function>
  auto with(Function&& function) {
    const py::gil_scoped_release released;
    const std::lock_guard lock(mutex);
    return function(solver);
  }

  // Calls function(solver, state) for a copy of the state, without the GIL. Throws py::value_error for a
  // state of another arm.
  template <class Function>
  auto with_own(const RodState& state, Function&& function) {
    require_same_arm(state, rest);
    RodState own = state;
    return with([&](RodDynamics& of) { return function(of, own); });
  }

  ArmsRod rod;
  std::mutex mutex;
  RodDynamics solver;
  const RodState rest;
};

using Owner = std::shared_ptr<Dynamics>;

RodStep step(Dynamics& dynamics, RodState& state, const py::object& tensions, const py::object& displacements,
             double h) {
  const TendonInput input = tendon_input(tensions, displacements, dynamics.rod.tendons());
  RodState after;
  RodStep done = dynamics.with_own(state, [&](RodDynamics& solver, RodState& own) {
    RodStep result = solver.step(own, input, dynamics.rod.loads, h);
    after = std::move(own);
    return result;
  });
  if (done.end == DynamicsEnd::bad_input) throw py::value_error(done.problem);
  state = std::move(after);
  return done;
}

py::dict energy(Dynamics& dynamics, const RodState& state) {
  const RodEnergy found = dynamics.with_own(state, [&](RodDynamics& solver, const RodState& own) {
    return solver.energy(own, dynamics.rod.loads);
  });
  py::dict result;
  result["kinetic"] = found.kinetic;
  result["strain"] = found.strain;
  result["gravity"] = found.gravity;
  result["total"] = found.total();
  return result;
}

py::dict linearize(Dynamics& dynamics, const RodState& state, const py::object& tensions,
                   const py::object& displacements) {
  const TendonInput input = tendon_input(tensions, displacements, dynamics.rod.tendons());
  const auto [linear, modes] = dynamics.with_own(state, [&](RodDynamics& solver, const RodState& own) {
    RodLinear found = solver.linearize(own, input, dynamics.rod.loads);
    RodModes natural = rod_modes(found.slopes);
    return std::pair(std::move(found), std::move(natural));
  });
  py::dict result;
  result["A"] = matrix_array(linear.A);
  result["B"] = matrix_array(linear.B);
  result["A_rest"] = matrix_array(linear.A_rest);
  result["B_rest"] = matrix_array(linear.B_rest);
  result["by_parameters"] = matrix_array(linear.by_parameters);
  result["tip_by_q"] = matrix_array(linear.tip_by_q);
  result["lengths_by_q"] = matrix_array(linear.lengths_by_q);
  result["mass"] = matrix_array(linear.slopes.mass);
  result["force_by_q"] = matrix_array(linear.slopes.force_by_q);
  result["force_by_v"] = matrix_array(linear.slopes.force_by_v);
  result["force_by_input"] = matrix_array(linear.slopes.force_by_input);
  result["frequencies_hz"] = vector_array(Eigen::Map<const Eigen::VectorXd>(
      modes.frequencies.data(), static_cast<Eigen::Index>(modes.frequencies.size())));
  result["damping_ratios"] = vector_array(Eigen::Map<const Eigen::VectorXd>(
      modes.damping_ratios.data(), static_cast<Eigen::Index>(modes.damping_ratios.size())));
  return result;
}

py::dict step_slopes(Dynamics& dynamics, const RodState& state, const py::object& tensions,
                     const py::object& displacements, double h) {
  const TendonInput input = tendon_input(tensions, displacements, dynamics.rod.tendons());
  const RodStepSlopes slopes = dynamics.with_own(state, [&](RodDynamics& solver, const RodState& own) {
    return solver.step_slopes(own, input, dynamics.rod.loads, h);
  });
  py::dict result;
  result["by_state"] = matrix_array(slopes.by_state);
  result["by_input"] = matrix_array(slopes.by_input);
  result["by_parameters"] = matrix_array(slopes.by_parameters);
  return result;
}

void bind_state(py::module_& module) {
  py::class_<RodState>(module, "RodState", "State of a moving elastic arm.")
      .def_readonly("time", &RodState::time, "Time, s.")
      .def_property_readonly(
          "q", [](const RodState& state) { return vector_array(state.q); }, "Strain modes, shape (size,).")
      .def_property_readonly(
          "momentum", [](const RodState& state) { return vector_array(state.momentum); },
          "Generalized momentum p = M(q) v, shape (size,).")
      .def_readonly("tensions", &RodState::tensions, "Tensions of the last step at the base, N.")
      .def(
          "copy", [](const RodState& state) { return state; }, "Returns a copy.")
      .def("__copy__", [](const RodState& state) { return state; })
      .def("__deepcopy__", [](const RodState& state, const py::dict&) { return state; });
  py::class_<RodStep>(module, "RodStep", "Result of a step.")
      .def_property_readonly("converged", &RodStep::converged,
                             "Whether the step converged; if not, the state did not change.")
      .def_readonly("iterations", &RodStep::iterations, "Number of linear systems solved.")
      .def_readonly("pieces", &RodStep::pieces, "Number of pieces into which the step was divided.");
}

void bind_quantities(py::class_<Dynamics, Owner>& dynamics) {
  using py::arg;
  const auto none = py::none();
  const auto size_of = [](const Dynamics& of) { return static_cast<py::ssize_t>(of.solver.chain().size()); };
  dynamics
      .def(
          "tip",
          [](Dynamics& of, const RodState& state) {
            return pose_array(of.rod.X_WB * of.with_own(state, [&](RodDynamics& solver, const RodState& own) {
              return solver.tip(own);
            }));
          },
          arg("state"), "Returns the tip's pose X_WT in the world, shape (4, 4).")
      .def(
          "backbone", [](const Dynamics& of, const RodState& state) { return of.rod.backbone(state.q); },
          arg("state"), "Returns the Backbone of a state.")
      .def(
          "velocity",
          [](Dynamics& of, const RodState& state) {
            return vector_array(of.with_own(
                state, [&](RodDynamics& solver, const RodState& own) { return solver.velocity(own); }));
          },
          arg("state"), "Returns the rates v = dq/dt, shape (size,).")
      .def(
          "tendon_lengths",
          [](Dynamics& of, const RodState& state) {
            return of.with_own(
                state, [&](RodDynamics& solver, const RodState& own) { return solver.tendon_lengths(own); });
          },
          arg("state"), "Returns the lengths of the tendons, m.")
      .def("energy", &energy, arg("state"),
           "Returns the energies kinetic, strain, gravity and total as a dict, J.")
      .def(
          "mass_matrix",
          [size_of](Dynamics& of, const Reals& q) {
            const Eigen::VectorXd at = vector_of(q, size_of(of), "q");
            return matrix_array(of.with([&](RodDynamics& solver) { return solver.mass_matrix(at); }));
          },
          arg("q"), "Returns the mass matrix M(q), shape (size, size).")
      .def(
          "stiffness_matrix", [](Dynamics& of) { return matrix_array(of.solver.stiffness_matrix()); },
          "Returns the stiffness K, shape (size, size); the strain energy is q^T K q / 2.")
      .def(
          "damping_matrix", [](Dynamics& of) { return matrix_array(of.solver.damping_matrix()); },
          "Returns the damping D, shape (size, size); viscous forces are -D v.")
      .def(
          "acceleration",
          [size_of](Dynamics& of, const Reals& q, const Reals& v, const py::object& tensions,
                    const py::object& displacements) {
            const Eigen::VectorXd at = vector_of(q, size_of(of), "q"), rate = vector_of(v, size_of(of), "v");
            const TendonInput input = tendon_input(tensions, displacements, of.rod.tendons());
            return vector_array(of.with(
                [&](RodDynamics& solver) { return solver.acceleration(at, rate, input, of.rod.loads); }));
          },
          arg("q"), arg("v"), arg("tensions") = none, arg("displacements") = none,
          "Returns the accelerations dv/dt, shape (size,).")
      .def("linearize", &linearize, arg("state"), arg("tensions") = none, arg("displacements") = none,
           "Returns the linearised motion x' = A x + B u as a dict of arrays: A, B for x = (q, p), A_rest, "
           "B_rest for\n"
           "x = (q, v) around a rod at rest, by_parameters, tip_by_q (6, size), lengths_by_q (tendons, "
           "size), mass,\n"
           "force_by_q, force_by_v, force_by_input, and frequencies_hz and damping_ratios of the oscillating "
           "modes.")
      .def("step_slopes", &step_slopes, arg("state"), arg("tensions") = none, arg("displacements") = none,
           arg("h") = 0.01,
           "Returns derivatives of (q, p, rate, force) after a step of h seconds as a dict of arrays: "
           "by_state (4 size,\n"
           "4 size), by_input (4 size, tendons), by_parameters (6 per section).");
}

}  // namespace

void bind_dynamics(py::module_& module) {
  using py::arg;
  bind_state(module);
  py::class_<Dynamics, Owner> dynamics(module, "Dynamics",
                                       "Motion of an arm whose sections have materials (key `material`), "
                                       "under its tendons, weight and loads.");
  dynamics
      .def(py::init([](const DescribedArm& arm, double spectral_radius, double tolerance) {
             return std::make_shared<Dynamics>(
                 arm, RodDynamicsConfig{.spectral_radius = spectral_radius, .tolerance = tolerance});
           }),
           arg("arm"), py::kw_only(), arg("spectral_radius") = 0.1, arg("tolerance") = 1e-7,
           "spectral_radius: numerical damping of fast motion, from 0 (most) to 1 (none). tolerance: of a "
           "step's\n"
           "equations, rad/s.")
      .def_property_readonly(
          "size", [](const Dynamics& of) { return of.solver.chain().size(); }, "Number of strain modes.")
      .def_property_readonly(
          "tendons", [](const Dynamics& of) { return of.rod.tendons(); }, "Number of tendons.")
      .def(
          "rest",
          [](Dynamics& of, const Equilibrium* at) {
            return of.with(
                [&](RodDynamics& solver) { return at != nullptr ? solver.rest(*at) : solver.rest(); });
          },
          arg("equilibrium") = py::none(),
          "Returns the unloaded arm at rest, or the arm at rest in an equilibrium.")
      .def(
          "start",
          [](Dynamics& of, const Reals& q, const Reals& v, const py::object& tensions,
             const py::object& displacements) {
            const auto size = static_cast<py::ssize_t>(of.solver.chain().size());
            const Eigen::VectorXd at = vector_of(q, size, "q"), rate = vector_of(v, size, "v");
            const TendonInput input = tendon_input(tensions, displacements, of.rod.tendons());
            return of.with([&](RodDynamics& solver) { return solver.start(at, rate, input, of.rod.loads); });
          },
          arg("q"), arg("v"), arg("tensions") = py::none(), arg("displacements") = py::none(),
          "Returns the state with modes q and rates v, each (size,).")
      .def("step", &step, arg("state"), arg("tensions") = py::none(), arg("displacements") = py::none(),
           arg("h") = 0.01,
           "Advances `state` in place by h seconds. Tensions, N, or displacements, m, have one number per "
           "tendon.\n"
           "Returns a RodStep.");
  bind_quantities(dynamics);
}

}  // namespace flexura::python
