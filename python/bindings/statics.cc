#include "flexura/mechanics/statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/inverse_statics.h"
#include "python/bindings/module.h"
#include "python/bindings/rod.h"
#include "python/bindings/threads.h"

namespace flexura::python {

ArmsRod::ArmsRod(const DescribedArm& arm)
    : rod(rod_of(arm.config, arm.drive)),
      loads(loads_of(arm.config)),
      X_WB(arm.model.driven().X_WB),
      tube(arm.model.driven(), rod),
      size(RodChain(rod).size()) {}

void ArmsRod::require_own(const Eigen::VectorXd& q) const {
  if (q.size() != size)
    throw py::value_error(fmt::format("{} strain modes: expected those of this arm, {}", q.size(), size));
}

void require_same_arm(const RodState& state, const RodState& own) {
  const auto is_as_long = [&](const Eigen::VectorXd& numbers) { return numbers.size() == own.q.size(); };
  const bool fits = is_as_long(state.q) && is_as_long(state.momentum) && is_as_long(state.rate) &&
                    is_as_long(state.force) && std::ranges::all_of(state.middle, is_as_long) &&
                    state.tensions.size() == own.tensions.size() &&
                    state.friction.size() == own.friction.size();
  if (!fits)
    throw py::value_error(
        fmt::format("state: {} strain modes and {} tendons: expected those of this arm, {} and {}",
                    state.q.size(), state.tensions.size(), own.q.size(), own.tensions.size()));
}

Backbone ArmsRod::backbone(const Eigen::VectorXd& q) const {
  require_own(q);
  return tube.backbone(q, std::vector<double>(rod.sections.size(), 1.0));
}

TendonArray::TendonArray(const std::optional<Reals>& tensions, const std::optional<Reals>& displacements,
                         std::size_t count, std::size_t tendons)
    : values_(tensions ? tensions : displacements), tendons_(tendons), by_displacement_(!tensions) {
  if (tensions && displacements) throw py::value_error("expected either tensions or displacements");
  if (!values_) return;
  if (values_->ndim() != 2 || values_->shape(0) != static_cast<py::ssize_t>(count) ||
      values_->shape(1) != static_cast<py::ssize_t>(tendons))
    throw py::value_error(fmt::format("{}: expected an array of shape ({}, {})",
                                      by_displacement_ ? "displacements" : "tensions", count, tendons));
  data_ = values_->data();
}

void TendonArray::read(std::size_t index, TendonInput& input) const {
  if (data_ == nullptr) return;
  auto& list = by_displacement_ ? input.displacements : input.tensions;
  list.assign(data_ + index * tendons_, data_ + (index + 1) * tendons_);
}

TendonInput tendon_input(const py::object& tensions, const py::object& displacements, std::size_t tendons) {
  if (!tensions.is_none() && !displacements.is_none())
    throw py::value_error("expected either tensions or displacements");
  TendonInput input{list_of(tensions), list_of(displacements)};
  const auto check = [&](const std::vector<double>& values, const py::object& given, const char* name) {
    if (!given.is_none() && values.size() != tendons)
      throw py::value_error(
          fmt::format("{}: {} given: expected {} values, one per tendon", name, values.size(), tendons));
  };
  check(input.tensions, tensions, "tensions");
  check(input.displacements, displacements, "displacements");
  return input;
}

namespace {

// RodStatics keeps its last solution, so only one thread may use it at a time.
struct Statics {
  explicit Statics(const DescribedArm& arm) : rod(arm), solver(rod.rod) {}

  ArmsRod rod;
  std::mutex mutex;
  RodStatics solver;
};

Equilibrium solve(Statics& statics, const py::object& tensions, const py::object& displacements,
                  const Equilibrium* near) {
  const TendonInput input = tendon_input(tensions, displacements, statics.rod.tendons());
  if (near != nullptr && near->converged()) statics.rod.require_own(near->q);
  Equilibrium found;
  {
    const py::gil_scoped_release released;
    const std::lock_guard lock(statics.mutex);
    found = near != nullptr ? statics.solver.settle(input, statics.rod.loads, *near)
                            : statics.solver.settle(input, statics.rod.loads);
  }
  if (found.end == StaticsEnd::bad_input) throw py::value_error(found.problem);
  return found;
}

py::dict solve_batch(Statics& statics, const std::optional<Reals>& tensions,
                     const std::optional<Reals>& displacements, std::size_t threads) {
  if (!tensions && !displacements) throw py::value_error("expected tensions or displacements");
  const Reals& given = tensions ? *tensions : *displacements;
  const std::size_t count = given.ndim() > 0 ? static_cast<std::size_t>(given.shape(0)) : 0;
  const TendonArray inputs(tensions, displacements, count, statics.rod.tendons());
  const auto rows = static_cast<py::ssize_t>(count);
  const Eigen::Index size = statics.solver.chain().size();
  const auto pulls = static_cast<py::ssize_t>(statics.rod.tendons());
  py::array_t<double> q(Sizes{rows, size}), tips(Sizes{rows, 4, 4}), forces(Sizes{rows, pulls});
  py::array_t<bool> converged(rows), stable(rows);
  double *to_q = q.mutable_data(), *to_tip = tips.mutable_data(), *to_force = forces.mutable_data();
  bool *to_converged = converged.mutable_data(), *to_stable = stable.mutable_data();
  {
    const py::gil_scoped_release released;
    share_out(count, threads, [&](std::size_t begin, std::size_t end) {
      RodStatics solver(statics.rod.rod);
      TendonInput input;
      for (std::size_t i = begin; i < end; ++i) {
        inputs.read(i, input);
        const Equilibrium found = solver.settle(input, statics.rod.loads);
        to_converged[i] = found.converged();
        to_stable[i] = found.stable;
        // An input that is not valid has no shape.
        const bool has_shape = found.q.size() == size;
        Eigen::Map<Eigen::VectorXd> modes(to_q + i * static_cast<std::size_t>(size), size);
        modes = has_shape ? found.q : Eigen::VectorXd::Constant(size, std::nan(""));
        write_pose(statics.rod.X_WB * found.tip, to_tip + 16 * i);
        for (std::size_t k = 0; k < statics.rod.tendons(); ++k)
          to_force[i * statics.rod.tendons() + k] = has_shape ? found.tensions[k] : std::nan("");
      }
    });
  }
  py::dict result;
  result["q"] = q;
  result["tip"] = tips;
  result["tensions"] = forces;
  result["converged"] = converged;
  result["stable"] = stable;
  return result;
}

InverseStaticsResult inverse(Statics& statics, const std::optional<Reals>& position,
                             const std::optional<Reals>& direction, const std::optional<Reals>& rotation,
                             const py::object& max_tension, const Equilibrium* start, double tolerance) {
  // Targets are relative to the base.
  const Pose X_BW = statics.rod.X_WB.inverse();
  RodTarget target;
  if (position) target.position = X_BW * Eigen::Vector3d(vector_of(*position, 3, "position"));
  if (direction) target.direction = X_BW.rotation * Eigen::Vector3d(vector_of(*direction, 3, "direction"));
  if (rotation) {
    if (rotation->ndim() != 2 || rotation->shape(0) != 3 || rotation->shape(1) != 3)
      throw py::value_error("rotation: expected an array of shape (3, 3)");
    target.rotation = X_BW.rotation * Eigen::Map<const RowMajor<3, 3>>(rotation->data());
  }
  std::vector<double> most;
  if (py::isinstance<py::float_>(max_tension) || py::isinstance<py::int_>(max_tension)) {
    most.assign(statics.rod.tendons(), py::cast<double>(max_tension));
  } else {
    most = tendon_input(max_tension, py::none(), statics.rod.tendons()).tensions;
  }
  InverseStaticsConfig config{.tolerance = tolerance};
  if (start != nullptr) {
    statics.rod.require_own(start->q);
    config.start = *start;
  }
  InverseStaticsResult found;
  {
    const py::gil_scoped_release released;
    const std::lock_guard lock(statics.mutex);
    found = solve_inverse_statics(statics.solver, target, statics.rod.loads, most, config);
  }
  if (found.end == InverseStaticsEnd::bad_input) throw py::value_error(found.problem);
  return found;
}

py::dict slopes(Statics& statics) {
  EquilibriumSlopes found;
  {
    const py::gil_scoped_release released;
    const std::lock_guard lock(statics.mutex);
    found = statics.solver.slopes();
  }
  py::dict result;
  result["q_by_input"] = matrix_array(found.q_by_input);
  result["tensions_by_input"] = matrix_array(found.tensions_by_input);
  result["lengths_by_input"] = matrix_array(found.lengths_by_input);
  result["q_by_tip"] = matrix_array(found.q_by_tip);
  result["tip_by_input"] = matrix_array(found.tip_by_input);
  result["tip_by_tip"] = matrix_array(found.tip_by_tip);
  result["tip_by_parameters"] = matrix_array(found.tip_by_parameters);
  result["q_by_parameters"] = matrix_array(found.q_by_parameters);
  return result;
}

void bind_equilibrium(py::module_& module) {
  py::class_<Equilibrium>(module, "Equilibrium",
                          "Equilibrium of an elastic arm under its tendons, weight and loads.")
      .def_property_readonly("converged", &Equilibrium::converged, "Whether an equilibrium was found.")
      .def_property_readonly(
          "reason", [](const Equilibrium& found) { return words(found.end); },
          "How the search ended, in words.")
      .def_readonly("stable", &Equilibrium::stable, "Whether the effect of a small push decays.")
      .def_readonly("snapped", &Equilibrium::snapped,
                    "Whether a real rod jumps on the way to this equilibrium.")
      .def_readonly("ambiguous", &Equilibrium::ambiguous, "Whether other equilibria were detected.")
      .def_readonly("iterations", &Equilibrium::iterations, "Number of linear systems solved.")
      .def_property_readonly(
          "q", [](const Equilibrium& found) { return vector_array(found.q); }, "Strain modes, shape (size,).")
      .def_readonly("tensions", &Equilibrium::tensions, "Tensions at the base, N; 0 for slack tendons.")
      .def_readonly("displacements", &Equilibrium::displacements, "Lengths pulled in at the base, m.")
      .def_readonly("tendon_lengths", &Equilibrium::tendon_lengths,
                    "Path lengths of the tendons through the arm, m.")
      .def_readonly("strain_energy", &Equilibrium::strain_energy, "Strain energy, J.")
      .def_property_readonly(
          "tip", [](const Equilibrium& found) { return pose_array(found.tip); },
          "Pose X_BT of the tip in the base's frame, shape (4, 4).")
      .def("__repr__", [](const Equilibrium& found) {
        return fmt::format("<flexura.Equilibrium: {}>", words(found.end));
      });
}

void bind_inverse_result(py::module_& module) {
  py::class_<InverseStaticsResult>(module, "InverseStaticsResult",
                                   "Tensions that bring an elastic arm to a target, or nearest to it.")
      .def_property_readonly("reached", &InverseStaticsResult::reached,
                             "Whether a stable equilibrium meets the target within the tolerance.")
      .def_property_readonly(
          "reason",
          [](const InverseStaticsResult& found) {
            return found.problem.empty() ? std::string(words(found.end)) : found.problem;
          },
          "How the search ended, in words.")
      .def_readonly("tensions", &InverseStaticsResult::tensions, "Tensions, N, a list of float.")
      .def_readonly("equilibrium", &InverseStaticsResult::equilibrium,
                    "The Equilibrium under these tensions; its displacements are what a drive pulls in.")
      .def_readonly("position_error", &InverseStaticsResult::position_error, "Distance from the target, m.")
      .def_readonly("angle_error", &InverseStaticsResult::angle_error, "Error of the orientation, rad.")
      .def("__repr__", [](const InverseStaticsResult& found) {
        return fmt::format("<flexura.InverseStaticsResult: {}, {:.3g} m>", words(found.end),
                           found.position_error);
      });
}

}  // namespace

void bind_statics(py::module_& module) {
  using py::arg;
  bind_equilibrium(module);
  bind_inverse_result(module);
  py::class_<Statics, std::shared_ptr<Statics>>(
      module, "Statics",
      "Equilibria of an arm whose sections have materials (key `material`), under its tendons, weight and "
      "loads.\n"
      "Inputs are tensions, N, or displacements (lengths pulled in at the base), m, one per tendon.")
      .def(py::init([](const DescribedArm& arm) { return std::make_shared<Statics>(arm); }), arg("arm"))
      .def_property_readonly(
          "size", [](const Statics& statics) { return statics.solver.chain().size(); },
          "Number of strain modes.")
      .def_property_readonly(
          "tendons", [](const Statics& statics) { return statics.rod.tendons(); }, "Number of tendons.")
      .def("solve", &solve, arg("tensions") = py::none(), arg("displacements") = py::none(),
           arg("near") = py::none(),
           "Returns the Equilibrium for an input (tendons,), from the undeformed arm or from the Equilibrium "
           "`near`.")
      .def("solve_batch", &solve_batch, arg("tensions") = py::none(), arg("displacements") = py::none(),
           arg("threads") = 1,
           "Solves for inputs (N, tendons), each from the undeformed arm. Returns a dict of arrays: q (N, "
           "size), tip\n"
           "(N, 4, 4) in the world, tensions (N, tendons), N, converged (N,), stable (N,).")
      .def(
          "inverse", &inverse, arg("position") = py::none(), arg("direction") = py::none(),
          arg("rotation") = py::none(), py::kw_only(), arg("max_tension") = 1000.0, arg("start") = py::none(),
          arg("tolerance") = 1e-8,
          "Finds the tensions with the least sum of squares that bring the tip to `position` (3,), m, with "
          "the z axis "
          "along\n`direction` (3,) or the orientation `rotation` (3, 3), in the world. max_tension: largest "
          "tension, "
          "N, one number or\none per tendon. start: the Equilibrium from which the search starts. Returns an "
          "InverseStaticsResult.")
      .def("slopes", &slopes,
           "Returns derivatives at the last solution of solve() as a dict of arrays: q_by_input (size, "
           "tendons),\n"
           "tensions_by_input, lengths_by_input (tendons, tendons), q_by_tip (size, 6), tip_by_input (6, "
           "tendons),\n"
           "tip_by_tip (6, 6), the compliance, tip_by_parameters and q_by_parameters (5 per section: "
           "relative changes\n"
           "of the stiffness against shear, stretch, bends, twist, and of the mass per length).")
      .def(
          "tip",
          [](const Statics& statics, const Equilibrium& at) { return pose_array(statics.rod.X_WB * at.tip); },
          arg("equilibrium"), "Returns the tip's pose X_WT in the world, shape (4, 4).")
      .def(
          "backbone",
          [](const Statics& statics, const Equilibrium& at) { return statics.rod.backbone(at.q); },
          arg("equilibrium"), "Returns the Backbone of an equilibrium.");
}

}  // namespace flexura::python
